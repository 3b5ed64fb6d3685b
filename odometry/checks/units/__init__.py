"""Units of speeds, positions and turns, and the track width."""
