"""Signs in a database: recorded, compiled or spelled movements with names, tags and sources."""
