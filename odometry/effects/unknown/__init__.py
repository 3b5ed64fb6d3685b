"""Parts of the motion that no named effect explains: smooth functions of what was recorded."""
