"""Measured velocities (velocity.csv) against treads, poses and gyroscope."""
