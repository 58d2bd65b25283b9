"""Curves: the movement between key postures."""
