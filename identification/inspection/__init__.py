"""What is in a log that nobody described yet, and the robot's file to begin with."""
