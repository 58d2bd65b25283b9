"""What MediaPipe's trackers would find in a perfect film of a clip: landmarks, and their files."""
