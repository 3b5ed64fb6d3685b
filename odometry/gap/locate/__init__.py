"""Where simulation and measurement disagree."""
