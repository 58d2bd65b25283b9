"""The tables of a database of signs, the same in SQLite and in PostgreSQL.

Names compare by code points in both, so that a prefix is a range of the index.
"""

from __future__ import annotations

from sqlalchemy import (
    JSON,
    Boolean,
    CheckConstraint,
    Column,
    Double,
    ForeignKey,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Table,
    UniqueConstraint,
)

VERSION = "0001"
"""The migration after which the tables are as they stand here."""
VERSION_TABLE = "azee_signs_version"

METADATA = MetaData(
    naming_convention={
        "ix": "ix_%(table_name)s_%(column_0_name)s",
        "uq": "uq_%(table_name)s_%(column_0_name)s",
        "ck": "ck_%(table_name)s_%(constraint_name)s",
        "fk": "fk_%(table_name)s_%(column_0_name)s",
        "pk": "pk_%(table_name)s",
    }
)
TEXT = String().with_variant(String(collation="C"), "postgresql")
"""Texts in the order of their code points, which is that of SQLite."""


def _of(table: str) -> ForeignKey:
    """Return a reference to a row without which its own row cannot be."""
    return ForeignKey(f"{table}.id", ondelete="CASCADE")


SKELETON = Table(
    "skeleton",
    METADATA,
    Column("id", Integer, primary_key=True),
    Column("digest", String, nullable=False, unique=True),
    Column("name", TEXT, nullable=False),
    Column("joints", JSON, nullable=False),
    Column("coordinates", JSON, nullable=False),
)
SIGN = Table(
    "sign",
    METADATA,
    Column("id", Integer, primary_key=True),
    Column("skeleton", ForeignKey("skeleton.id"), nullable=False),
    Column("language", TEXT, nullable=False),
    Column("name", TEXT, nullable=False),
    Column("variant", TEXT, nullable=False),
    Column("kind", String, nullable=False),
    Column("duration_s", Double, nullable=False),
    Column("rate", Double),
    Column("frames", Integer, nullable=False),
    Column("attack_s", Double, nullable=False),
    Column("decay_s", Double, nullable=False),
    Column("repositioned", Boolean, nullable=False),
    Column("provenance", JSON, nullable=False),
    Column("licence", String, nullable=False),
    Column("digest", String, nullable=False),
    UniqueConstraint("skeleton", "language", "name", "variant", name="uq_sign_key"),
    CheckConstraint("kind IN ('recorded', 'azee', 'spelled')", name="kind"),
    CheckConstraint("attack_s >= 0 AND decay_s >= 0", name="attack_and_decay"),
    Index("ix_sign_name", "name"),
)
TAG = Table(
    "tag",
    METADATA,
    Column("sign", _of("sign"), primary_key=True),
    Column("text", TEXT, primary_key=True),
    Index("ix_tag_text", "text"),
)
MOTION = Table(
    "motion",
    METADATA,
    Column("sign", _of("sign"), primary_key=True),
    Column("clip", LargeBinary, nullable=False),
    Column("original", LargeBinary, nullable=False),
    Column("original_name", TEXT, nullable=False),
    Column("original_digest", String, nullable=False),
    Index("ix_motion_original_digest", "original_digest"),
)
