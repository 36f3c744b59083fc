"""The actions of a user with the twin, one verb in each file."""
