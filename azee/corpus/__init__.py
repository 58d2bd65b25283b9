"""What a corpus of AZee texts has in it, counted."""
