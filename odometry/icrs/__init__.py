"""ICRs of the treads, measured: from twists to points, a table and medians."""
