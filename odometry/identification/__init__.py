"""Parameters of kinematic models from recorded runs."""
