"""The moves of a search over a horizon, each with its reason."""
