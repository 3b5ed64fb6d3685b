"""Figures and one page of a run: what was seen, when the terrain changed, how far off it is."""
