"""The MuJoCo side of the robot: model, native law, start, runs."""
