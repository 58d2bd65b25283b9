"""What is laid on the movement: face, trills, breathing and blinking, labels."""
