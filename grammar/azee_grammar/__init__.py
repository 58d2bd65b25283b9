"""The AZee language as text: source, diagnostics, syntax tree, parser and vocabulary."""
