"""From an image to a label of the terrain ahead, or to the reason why there is none."""
