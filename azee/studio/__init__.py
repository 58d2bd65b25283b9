"""The studio: a page on this machine to write, see and correct signing, and its server."""
