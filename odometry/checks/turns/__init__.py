"""How turns and scales by several sensors belong together, all along and in parts."""
