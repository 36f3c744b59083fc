"""The commands of `python -m identification`, one a file."""
