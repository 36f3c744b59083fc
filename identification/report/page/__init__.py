"""One-file pages and their figures, for all reports."""
