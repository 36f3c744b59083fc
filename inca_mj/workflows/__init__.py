"""What a user does with the twin, one verb in each file."""
