"""Feature vectors of patches: SFTA, statistics, and layers of image networks."""
