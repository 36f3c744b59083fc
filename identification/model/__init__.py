"""A MuJoCo model that predicts what a log should show."""
