"""Modes identified from runs, and how far they are off on drives left out."""
