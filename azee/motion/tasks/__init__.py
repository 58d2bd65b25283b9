"""What a score asks of the body, and when."""
