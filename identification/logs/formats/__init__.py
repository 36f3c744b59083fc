"""Readers of the file formats that a log may have: each returns a table of columns."""
