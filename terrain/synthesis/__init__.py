"""The parts of a synthetic run: photographs, textured terrain, the camera's images, patches."""
