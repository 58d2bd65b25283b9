"""A language server: what editors ask about AZee texts, answered over the protocol."""
