"""The moves of the search by innovations: each proposes one change of the effects."""
