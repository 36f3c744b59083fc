"""Sections, figures and JSON for reports about this robot."""
