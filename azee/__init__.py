"""AZee: from a formal description of a sign-language utterance to a signing body."""
