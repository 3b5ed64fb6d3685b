"""The main job frame by frame, as on a robot."""
