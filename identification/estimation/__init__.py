"""Values of parameters from logs, and what they are worth."""
