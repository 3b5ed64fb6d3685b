"""What a recording shows of its own stamps and noise before it is replayed."""
