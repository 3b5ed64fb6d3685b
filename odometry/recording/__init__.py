"""One recording: its robot, its frames in time order, its terrains, its sensors and its parts."""
