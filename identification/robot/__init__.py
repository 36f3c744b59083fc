"""A robot of the user: one TOML file, its model and its log."""
