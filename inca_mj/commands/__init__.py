"""The commands of `inca`, one a module; heavy imports wait until a command runs."""
