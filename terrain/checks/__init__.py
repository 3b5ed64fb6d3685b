"""What is odd about the camera of a recording and its images."""
