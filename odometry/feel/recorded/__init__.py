"""What sensors recorded, in windows: signals, spectra, motion, and their checks."""
