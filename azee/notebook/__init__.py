"""Shows scores, clips, bodies and reports in notebooks."""
