"""One filter for each mode, weighed by what it explains (Salvi 2024, eq. 4-11)."""
