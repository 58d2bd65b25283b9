"""A movement as data: clips, their files, recordings, and operations on them."""
