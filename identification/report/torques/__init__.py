"""The report on torques, and what they say of the names of a search."""
