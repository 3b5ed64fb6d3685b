"""From labels of places to the terrain in force."""
