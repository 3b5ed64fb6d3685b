"""Faults of a part of a recording: another unit, a sign, exchanged columns, rounding."""
