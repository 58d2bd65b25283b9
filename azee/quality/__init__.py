"""The quality of a movement: reports and measures."""
