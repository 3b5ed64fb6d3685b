"""The result of a run: what was evaluated, what contradicts, and what to know before its use."""
