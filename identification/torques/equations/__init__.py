"""The equations of torques along measured motions, and their base parameters."""
