"""A data set by one command."""
