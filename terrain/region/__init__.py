"""The region of terrain ahead of the robot, and its view from above."""
