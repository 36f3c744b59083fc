"""The commands of `inca`, one a module; importing one is cheap, running it imports what it needs."""
