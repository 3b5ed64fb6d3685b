"""What is known of a recorded run at any moment, and where no window may lie."""
