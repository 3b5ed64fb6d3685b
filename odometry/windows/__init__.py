"""Windows of recorded motion: how runs are cut, what is simulated over them, and their noise."""
