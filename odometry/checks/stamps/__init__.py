"""Stamps of the files, rows that are lost or mixed, and what is late against what."""
