"""Files and folders that this program makes: what made them, and whether they are whole."""
