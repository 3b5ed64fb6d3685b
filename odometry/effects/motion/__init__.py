"""Effects on the motion of the robot: terrains, turns, slopes, inertia, traction."""
