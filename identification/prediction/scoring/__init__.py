"""Scores of candidates: how much of the windows' residual each would explain."""
