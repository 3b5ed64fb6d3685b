"""Labelled photographs: found, grouped, cut to patches, altered, and what is wrong with them."""
