"""What a prompt or an editor wants to know of a text that is still being written."""
