"""Effects that a model may lack, of joints and inputs, and a plant that has them."""
