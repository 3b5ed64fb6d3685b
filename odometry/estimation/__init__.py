"""Filters that estimate pose and ICRs."""
