"""Refits with another effect, and their proof by unseen records."""
