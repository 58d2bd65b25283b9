"""A language server for AZee texts."""
