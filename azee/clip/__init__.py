"""A movement as data: clips, their files, recordings, and what is done to one."""
