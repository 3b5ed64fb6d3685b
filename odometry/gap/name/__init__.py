"""Which effects are missing: candidates, the gates that a name must pass, what no name explains."""
