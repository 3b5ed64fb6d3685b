"""Effects on the tread speeds: late or limited drives, wheels, slip of a tread."""
