"""How scores, clips, bodies and reports show themselves in a notebook."""
