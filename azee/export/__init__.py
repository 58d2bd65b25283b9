"""Clips and scores written in formats that others can open."""
