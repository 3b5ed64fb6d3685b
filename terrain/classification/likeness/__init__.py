"""Whether images look like the training photographs, as a run or a folder."""
