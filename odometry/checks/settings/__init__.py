"""What run.toml says, and columns whose names are nearly known."""
