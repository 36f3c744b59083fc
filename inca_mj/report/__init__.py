"""What reports and JSON say of the robot."""
