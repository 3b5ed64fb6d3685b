"""The measured poses: positions, yaw, and the course that they drive."""
