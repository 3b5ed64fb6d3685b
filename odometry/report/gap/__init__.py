"""The page of a gap."""
