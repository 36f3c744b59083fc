"""The choice of the next effect, or set of effects, among its rivals."""
