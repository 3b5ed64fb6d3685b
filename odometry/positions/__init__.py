"""Heading from measured positions: where the robot pointed, of which only places were measured."""
