"""The versions of the tables; each names the one before it."""
