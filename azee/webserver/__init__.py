"""What web pages on this machine have in common: who may ask, where they listen, how they end."""
