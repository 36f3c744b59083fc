"""The file of a robot: its TOML, the model that it names, and its parameters."""
