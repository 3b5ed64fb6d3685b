"""A time-stamped table, and rows that came late or together."""
