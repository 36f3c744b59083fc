"""A log of a robot: file in, checked value out."""
