"""Checks of a log of INCA against its twin: which columns are not what they are called."""
