"""Short windows in which every measured pose counts."""
