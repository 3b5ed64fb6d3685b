"""ICRs and errors as figures."""
