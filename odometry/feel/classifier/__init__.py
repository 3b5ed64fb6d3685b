"""The parts of a classifier by feel, and how unlike its training a window is."""
