"""What a recording says of motion: treads, gyroscope and poses, and how they belong together."""
