"""Changes of the tables, one file a version, which alembic runs in order."""
