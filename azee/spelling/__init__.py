"""Fingerspelling: when its letters happen, and whether people like to watch it."""
