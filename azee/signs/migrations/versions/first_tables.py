"""The first tables: skeletons, signs, tags, motion.

It stands still while `azee.signs.tables` changes: later versions change what it makes.
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision: str | None = None

TEXT = sa.String().with_variant(sa.String(collation="C"), "postgresql")


def upgrade() -> None:
    """Make the tables."""
    op.create_table(
        "skeleton",
        sa.Column("id", sa.Integer, nullable=False),
        sa.Column("digest", sa.String, nullable=False),
        sa.Column("name", TEXT, nullable=False),
        sa.Column("joints", sa.JSON, nullable=False),
        sa.Column("coordinates", sa.JSON, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_skeleton"),
        sa.UniqueConstraint("digest", name="uq_skeleton_digest"),
    )
    op.create_table(
        "sign",
        sa.Column("id", sa.Integer, nullable=False),
        sa.Column("skeleton", sa.Integer, nullable=False),
        sa.Column("language", TEXT, nullable=False),
        sa.Column("name", TEXT, nullable=False),
        sa.Column("variant", TEXT, nullable=False),
        sa.Column("kind", sa.String, nullable=False),
        sa.Column("duration_s", sa.Double, nullable=False),
        sa.Column("rate", sa.Double),
        sa.Column("frames", sa.Integer, nullable=False),
        sa.Column("attack_s", sa.Double, nullable=False),
        sa.Column("decay_s", sa.Double, nullable=False),
        sa.Column("repositioned", sa.Boolean, nullable=False),
        sa.Column("provenance", sa.JSON, nullable=False),
        sa.Column("licence", sa.String, nullable=False),
        sa.Column("digest", sa.String, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_sign"),
        sa.ForeignKeyConstraint(["skeleton"], ["skeleton.id"], name="fk_sign_skeleton"),
        sa.UniqueConstraint("skeleton", "language", "name", "variant", name="uq_sign_key"),
        sa.CheckConstraint("kind IN ('recorded', 'azee', 'spelled')", name=op.f("ck_sign_kind")),
        sa.CheckConstraint("attack_s >= 0 AND decay_s >= 0", name=op.f("ck_sign_attack_and_decay")),
    )
    op.create_index("ix_sign_name", "sign", ["name"])
    op.create_table(
        "tag",
        sa.Column("sign", sa.Integer, nullable=False),
        sa.Column("text", TEXT, nullable=False),
        sa.PrimaryKeyConstraint("sign", "text", name="pk_tag"),
        sa.ForeignKeyConstraint(["sign"], ["sign.id"], name="fk_tag_sign", ondelete="CASCADE"),
    )
    op.create_index("ix_tag_text", "tag", ["text"])
    op.create_table(
        "motion",
        sa.Column("sign", sa.Integer, nullable=False),
        sa.Column("clip", sa.LargeBinary, nullable=False),
        sa.Column("original", sa.LargeBinary, nullable=False),
        sa.Column("original_name", TEXT, nullable=False),
        sa.Column("original_digest", sa.String, nullable=False),
        sa.PrimaryKeyConstraint("sign", name="pk_motion"),
        sa.ForeignKeyConstraint(["sign"], ["sign.id"], name="fk_motion_sign", ondelete="CASCADE"),
    )
    op.create_index("ix_motion_original_digest", "motion", ["original_digest"])


def downgrade() -> None:
    """Remove the tables."""
    for table in ("motion", "tag", "sign", "skeleton"):
        op.drop_table(table)
