"""What a check says: findings, their words and levels, and which follow from others."""
