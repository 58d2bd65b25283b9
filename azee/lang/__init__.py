"""The AZee language at work: values, evaluation and rule libraries."""
