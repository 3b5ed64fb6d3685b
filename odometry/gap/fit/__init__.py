"""Effects fitted to the measured runs, and what they gain on windows held out."""
