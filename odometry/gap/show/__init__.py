"""A gap result as sentences and files."""
