"""The times of a movement as performed: a way takes as long as a person needs for it."""
