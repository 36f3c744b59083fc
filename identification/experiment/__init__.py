"""The next experiment: a motion or an input, within limits, that tells what is not known yet."""
