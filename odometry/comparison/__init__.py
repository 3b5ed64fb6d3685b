"""Models side by side on runs that they were not identified on."""
