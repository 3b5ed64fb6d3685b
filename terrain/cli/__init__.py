"""The command `terrain-odometry`: its entry point, and what several verbs use."""
