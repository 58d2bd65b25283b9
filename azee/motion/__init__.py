"""From scores to motion: keyframes, curves and clips."""
