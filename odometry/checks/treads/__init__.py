"""The tread speeds: their values, sides, scales, and the motion that they stand for."""
