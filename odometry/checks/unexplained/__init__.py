"""What still differs between sensors where no known cause explains it."""
