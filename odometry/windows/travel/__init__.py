"""Windows of equal wheel travel, and what a model predicts over them."""
