"""The bench of graphics processors: the same worlds in each simulator, a module each."""
