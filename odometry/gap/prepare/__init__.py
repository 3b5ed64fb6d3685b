"""Windows of the runs, the base calibrated on them, and the noise floor."""
