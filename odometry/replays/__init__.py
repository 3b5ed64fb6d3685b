"""A run driven again through the filter: the loop, its estimates, and what they have learned."""
