"""Files and folders of results: read, written whole or not at all, and read again."""
