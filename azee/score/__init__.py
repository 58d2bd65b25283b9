"""Nested timed scores: what an AZee expression evaluates to."""
