"""Rows of a run from messages: in order of time, poses, positions, images, lens."""
