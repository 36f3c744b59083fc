"""What a user does with the twin, one verb a file."""
