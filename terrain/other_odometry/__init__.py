"""Odometry of other programs beside a finished run."""
