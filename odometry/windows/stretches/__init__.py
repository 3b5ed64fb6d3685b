"""Stretches of measured positions, for runs without a measured yaw."""
