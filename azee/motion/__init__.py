"""From a score to the movement of a body: tasks, key postures, curves, overlays."""
