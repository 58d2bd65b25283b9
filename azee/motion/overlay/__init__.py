"""Overlays: what is added to the movement: trills, face, idle motion, and labels of the blocks."""
