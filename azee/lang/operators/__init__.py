"""The native operators, by theme; each module lists its own in `OPERATORS`."""
