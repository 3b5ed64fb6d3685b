"""Files in and out: run folders, CSV tables, TUM trajectories."""
