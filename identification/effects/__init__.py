"""What a model may lack: effects of joints and inputs, and a plant that has them."""
