"""Latitude and longitude: which rows are places, and metres east and north of an origin."""
