"""What is odd about a recording, found before anything is fitted to it."""
