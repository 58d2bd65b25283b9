"""Pictures and films of a body, and drawings of scores."""
