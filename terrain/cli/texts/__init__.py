"""What single verbs print and write."""
