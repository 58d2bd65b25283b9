"""Parts of a binary glTF 2.0 file: the document with its buffer, mesh, skin and animation."""
