"""What a tracker trained on people sees in our films: an eye that is not ours."""
