"""What the messages of a topic are, and which topics of a bag could serve a run."""
