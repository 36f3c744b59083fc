"""The laws and records of effects, by what they act on: joints, inputs, sensors, bodies."""
