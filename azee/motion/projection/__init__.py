"""Projection: the whole movement is drawn onto what is in force, as smoothly as possible."""
