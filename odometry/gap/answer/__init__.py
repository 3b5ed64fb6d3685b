"""The answer: the verdict, what the data do not distinguish from it, and what to drive next."""
