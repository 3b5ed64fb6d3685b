"""The parts of a synthetic run: photographs, textured ground, the camera's view of it, patches."""
