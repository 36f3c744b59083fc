"""The robot linearised: at a pose, along a log, and over the workspace."""
