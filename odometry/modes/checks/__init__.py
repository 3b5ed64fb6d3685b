"""What contradicts the most probable mode, so that it is not named."""
