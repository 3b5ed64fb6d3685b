"""Columns that were computed from others, and so cannot judge them."""
