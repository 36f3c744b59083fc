"""The commands of `identification`, one a file."""
