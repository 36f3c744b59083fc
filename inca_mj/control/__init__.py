"""The robot under control: paths, an inverse model and an observer made of a twin, and tasks."""
