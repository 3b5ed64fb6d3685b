"""The camera: ground plane to image pixels and back, its values, and its lens."""
