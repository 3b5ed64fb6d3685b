"""The command `terrain-odometry`, one file a verb."""
