"""What was found, in the formats of the programs that use it."""
