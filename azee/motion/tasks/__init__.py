"""Tasks: what a score requires of the body, and when."""
