"""A MuJoCo model as a plant that has effects on its joints, bodies, inputs and sensors."""
