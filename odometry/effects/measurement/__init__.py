"""Effects on what is measured: faults of the reference, its stamps, its map, the gyroscope."""
