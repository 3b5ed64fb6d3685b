"""Where the terrain of a run comes from: camera, labels, motion, feel, or nowhere."""
