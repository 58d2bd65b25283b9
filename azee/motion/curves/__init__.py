"""The movement between key postures."""
