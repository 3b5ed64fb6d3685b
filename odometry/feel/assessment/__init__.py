"""What a classifier is worth on runs held out: scores, evidence, limits, doubted runs."""
