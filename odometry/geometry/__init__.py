"""Angles and rigid motions."""
