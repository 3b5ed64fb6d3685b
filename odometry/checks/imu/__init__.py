"""Gyroscope, roll and pitch, and the side to which the robot turns."""
