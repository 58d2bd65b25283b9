"""Run by alembic, on the connection and in the transaction of whoever calls it."""

from __future__ import annotations

from alembic import context

from azee.signs.tables import METADATA, VERSION_TABLE

context.configure(
    connection=context.config.attributes["connection"],
    target_metadata=METADATA,
    version_table=VERSION_TABLE,
    transactional_ddl=True,
    render_as_batch=True,
)
with context.begin_transaction():
    context.run_migrations()
