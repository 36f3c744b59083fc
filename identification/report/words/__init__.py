"""Errors, values, effects and parts of a log in words, for all reports."""
