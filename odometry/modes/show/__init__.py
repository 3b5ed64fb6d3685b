"""What was found of the modes of a run: sentences, scores and files."""
