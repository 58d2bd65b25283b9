"""Texts as nested blocks: a lossless view of the syntax tree, and edits that lose nothing."""
