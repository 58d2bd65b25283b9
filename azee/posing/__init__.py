"""The body posed by hand, and the text that puts it there."""
