"""Formats of movement and of scores that other programs open."""
