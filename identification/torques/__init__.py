"""The evidence of torques: forces that a measured motion needs, linear in what is sought."""
