"""Results on a robot: their records, the comparison on unseen data, and their files."""
