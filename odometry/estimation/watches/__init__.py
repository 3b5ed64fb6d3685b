"""Watches of the filter: sensors, rest, slip and a robot that is stuck, frame by frame."""
