"""Labelled patches from recordings: terrain that an image shows and the robot then drove over."""
