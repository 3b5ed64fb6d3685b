"""Nearest neighbours: their spaces, votes, calibration, and distances that are too far."""
