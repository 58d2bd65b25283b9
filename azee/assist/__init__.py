"""What a prompt or an editor shows for a text that is still being written."""
