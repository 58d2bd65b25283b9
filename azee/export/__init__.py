"""Writes clips and scores in formats that other programs open."""
