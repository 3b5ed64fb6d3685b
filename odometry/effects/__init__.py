"""Effects that can be added to a kinematic model, one file each."""
