"""Terrain by feel along a run, from a file or live, and its files."""
