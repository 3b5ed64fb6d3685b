"""Bag files: the formats, what in them is damaged, topics and their messages."""
