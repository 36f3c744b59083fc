"""The verdict of a search: what is named, what speaks against it, and what is left."""
