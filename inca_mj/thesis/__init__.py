"""Chapters 2.4 and 3 of the thesis computed again: its trials, tables and figures beside ours."""
