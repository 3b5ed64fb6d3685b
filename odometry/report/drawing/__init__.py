"""What every page and figure is drawn with."""
