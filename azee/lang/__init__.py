"""The AZee language: values, evaluation and rule libraries."""
