"""The page of skid modes."""
