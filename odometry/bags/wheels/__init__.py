"""Wheels and treads: their names, sides, speeds and counters, and which topic to take."""
