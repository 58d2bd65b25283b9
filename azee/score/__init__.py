"""Nested timed scores, the values of AZee utterances."""
