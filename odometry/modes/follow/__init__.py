"""The filters that follow modes along a run, and the answers by their probabilities."""
