"""Models fitted to windows of several records, their std and their errors."""
