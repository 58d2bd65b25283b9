"""What a movement is worth: reports and measures."""
