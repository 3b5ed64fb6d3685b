"""What every effect is: what it acts on, its course in time, and the model that it is added to."""
