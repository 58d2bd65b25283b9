"""A database of signs: one transaction a sign, so that a process can be killed at any moment.

with SignDatabase.open("signs.db") as signs:
    sign = signs.one(Identity("BONJOUR"))
    clip = signs.clip(sign, rig)
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import ExitStack
from dataclasses import replace
from types import TracebackType
from typing import TYPE_CHECKING

from sqlalchemy import Connection, delete, insert, select, update
from sqlalchemy.exc import IntegrityError

from azee.signs.connection import Store, file_of, place_of
from azee.signs.fault import SignsError
from azee.signs.query import ALL_SIGNS, Query, found_in
from azee.signs.sign import Identity, Motion, Sign, SignFacts, digest_of, written
from azee.signs.skeleton import StoredSkeleton
from azee.signs.tables import MOTION, SIGN, SKELETON, TAG
from azee.signs.versions import check_version, migrate

if TYPE_CHECKING:
    from azee.clip.clip import Clip
    from azee_rig.rig import Rig


class SignDatabase:
    """Signs with their motion, in SQLite or PostgreSQL."""

    def __init__(self, store: Store) -> None:
        self.store = store

    @classmethod
    def open(cls, place: str) -> SignDatabase:
        """Open a database that exists.

        Args: place: the path of a file, or a URL.
        Raises: SignsError: sign-database: there is none, or it is of another version.
        """
        url = place_of(place)
        file = file_of(url)
        if file is not None and not file.is_file():
            what = "a directory, not a database" if file.is_dir() else "no such file"
            remedy = "`azee db create` makes a database; --db names another"
            raise SignsError("sign-database", f"`{file}`: {what}", remedy)
        store = Store(url)
        with ExitStack() as refused:
            refused.callback(store.close)
            check_version(store)
            refused.pop_all()
        return cls(store)

    @classmethod
    def create(cls, place: str) -> tuple[SignDatabase, str | None]:
        """Make a database, or bring one of an older azee up to date.

        Returns: it, and the version that it had before, if it existed.
        Raises: SignsError: sign-database: it cannot be made, or is another program's.
        """
        url = place_of(place)
        file = file_of(url)
        if file is not None and file.is_dir():
            raise SignsError("sign-database", f"`{file}` is a directory")
        if file is not None and not file.parent.is_dir():
            raise SignsError("sign-database", f"there is no folder `{file.parent}` for `{file}`")
        store = Store(url)
        with ExitStack() as refused:
            refused.callback(store.close)
            before = migrate(store)
            store.write_ahead()
            refused.pop_all()
        return cls(store), before

    def __enter__(self) -> SignDatabase:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.store.close()

    # Looking up

    def find(self, query: Query = ALL_SIGNS) -> list[Sign]:
        """Return the signs that are meant, in the order of their names."""
        with self.store.reading() as connection:
            return found_in(connection, list(query.conditions()))

    def one(self, name: str, *, language: str | None = None, variant: str | None = None) -> Sign:
        """Return the one sign of a name.

        Raises: SignsError: unknown-sign: there is none, or several of which none is meant.
        """
        found = self.find(Query(name=name, language=language, variant=variant))
        if len(found) == 1:
            return found[0]
        if not found:
            near = ", ".join(f"`{each.identity}`" for each in self.find(Query(prefix=name[:2]))[:5])
            remedy = f"names that begin alike: {near}" if near else "`azee db list` shows all"
            message = f"`{self.store.name}` has no sign `{name}`"
            raise SignsError("unknown-sign", message, remedy)
        several = ", ".join(f"`{each.identity}` for {each.skeleton}" for each in found)
        raise SignsError(
            "unknown-sign",
            f"{len(found)} signs are called `{name}`: {several}",
            "name one with --language and --variant",
        )

    def made_from(self, original: bytes, skeleton: StoredSkeleton) -> Sign | None:
        """Return a sign of a skeleton that was made from a file with these bytes."""
        wanted = MOTION.c.original_digest == digest_of(original)
        with self.store.reading() as connection:
            of = select(MOTION.c.sign).where(wanted)
            conditions = [SIGN.c.id.in_(of), SKELETON.c.digest == skeleton.digest]
            return next(iter(found_in(connection, conditions)), None)

    def skeletons(self) -> list[StoredSkeleton]:
        """Return all skeletons."""
        with self.store.reading() as connection:
            rows = connection.execute(select(SKELETON).order_by(SKELETON.c.id))
            return [
                StoredSkeleton(r.name, r.digest, tuple(r.joints), tuple(r.coordinates))
                for r in rows
            ]

    # Motion

    def motion(self, sign: Sign) -> Motion:
        """Return both blobs of a sign, as they were stored.

        Raises: SignsError: damaged-sign: one is not what was stored. unknown-sign: it is gone.
        """
        with self.store.reading() as connection:
            row = connection.execute(select(MOTION).where(MOTION.c.sign == sign.number)).first()
        if row is None:
            raise SignsError("unknown-sign", f"the sign `{sign.identity}` is gone")
        intact = digest_of(row.original) == row.original_digest
        if digest_of(row.clip) != sign.digest:
            remedy = "the file that it came from is intact: `azee db export --original` writes it"
            raise _damaged(sign, "movement", remedy if intact else None)
        if not intact:
            raise _damaged(sign, "original file", None)
        return Motion(row.clip, row.original, row.original_name)

    def original(self, sign: Sign) -> tuple[str, bytes]:
        """Return name and bytes of the file that a sign came from.

        Raises: SignsError: damaged-sign, unknown-sign.
        """
        columns = (MOTION.c.original_name, MOTION.c.original, MOTION.c.original_digest)
        with self.store.reading() as connection:
            row = connection.execute(select(*columns).where(MOTION.c.sign == sign.number)).first()
        if row is None:
            raise SignsError("unknown-sign", f"the sign `{sign.identity}` is gone")
        if digest_of(row.original) != row.original_digest:
            raise _damaged(sign, "original file", None)
        return row.original_name, row.original

    def clip(self, sign: Sign, rig: Rig) -> Clip:
        """Return the movement of a sign on its body, turned to the viewer if it is repositioned.

        Raises: SignsError: other-skeleton: the body has another. damaged-sign, unknown-sign.
        """
        from azee.clip.archive import ClipFileError, unpack_clip
        from azee.clip.facing import facing_viewer

        if StoredSkeleton.of(rig).digest != sign.skeleton_digest:
            raise SignsError(
                "other-skeleton",
                f"`{sign.identity}` was stored for the skeleton of `{sign.skeleton}`, "
                f"which is not that of the body `{rig.name}`",
                "write it with `azee db export --original` and add it again with --rig",
            )
        data = self.motion(sign).clip
        try:
            clip = unpack_clip(data, rig, str(sign.identity))
        except ClipFileError as error:
            raise SignsError("damaged-sign", str(error)) from error
        if sign.facts.repositioned:
            start_s, timing = float(clip.times[0]), sign.facts.timing
            body = start_s + timing.attack_s, start_s + timing.duration_s - timing.decay_s
            clip, _ = facing_viewer(clip, rig.coordinates, *body)
        return clip

    # Changes

    def add(self, facts: SignFacts, motion: Motion, skeleton: StoredSkeleton) -> Sign:
        """Store a sign, in one transaction.

        Raises: SignsError: sign-exists: the skeleton has one of that name, language and variant.
        """
        identity, timing = facts.identity, facts.timing
        row = self._skeleton(skeleton)
        try:
            with self.store.writing() as connection:
                number = connection.execute(
                    insert(SIGN)
                    .returning(SIGN.c.id)
                    .values(
                        skeleton=row,
                        language=identity.language,
                        name=identity.name,
                        variant=identity.variant,
                        kind=facts.kind,
                        duration_s=timing.duration_s,
                        rate=timing.rate,
                        frames=timing.frames,
                        attack_s=timing.attack_s,
                        decay_s=timing.decay_s,
                        repositioned=facts.repositioned,
                        provenance=dict(facts.provenance),
                        licence=facts.licence,
                        digest=digest_of(motion.clip),
                    )
                ).scalar_one()
                connection.execute(
                    insert(MOTION).values(
                        sign=number,
                        clip=motion.clip,
                        original=motion.original,
                        original_name=motion.original_name,
                        original_digest=digest_of(motion.original),
                    )
                )
                _add_tags(connection, number, facts.tags)
        except IntegrityError as error:
            raise _exists(self.store, identity) from error
        return Sign(number, facts, skeleton.name, skeleton.digest, digest_of(motion.clip))

    def tag(self, sign: Sign, add: Iterable[str] = (), remove: Iterable[str] = ()) -> Sign:
        """Give a sign tags and take others away; returns it as it is then."""
        new = {written(tag, "a tag") for tag in add}
        old = {written(tag, "a tag") for tag in remove}
        with self.store.writing() as connection:
            _hold(connection, sign)
            gone = (TAG.c.sign == sign.number) & TAG.c.text.in_(new | old)
            connection.execute(delete(TAG).where(gone))
            _add_tags(connection, sign.number, new - old)
            return found_in(connection, [SIGN.c.id == sign.number])[0]

    def rename(self, sign: Sign, identity: Identity) -> Sign:
        """Give a sign another name, language or variant; returns it as it is then.

        Raises: SignsError: sign-exists: another has them. unknown-sign: it is gone.
        """
        new = {
            "name": identity.name, "language": identity.language, "variant": identity.variant,
        }  # fmt: skip
        try:
            with self.store.writing() as connection:
                _hold(connection, sign)
                connection.execute(update(SIGN).where(SIGN.c.id == sign.number).values(new))
        except IntegrityError as error:
            raise _exists(self.store, identity) from error
        return replace(sign, facts=replace(sign.facts, identity=identity))

    def reposition(self, sign: Sign, *, turned: bool) -> Sign:
        """Have trunk and head of a sign face the viewer, or as recorded; returns it as it is then.

        What is stored does not change. Raises: SignsError: unknown-sign: it is gone.
        """
        with self.store.writing() as connection:
            _hold(connection, sign)
            change = update(SIGN).where(SIGN.c.id == sign.number).values(repositioned=turned)
            connection.execute(change)
        return replace(sign, facts=replace(sign.facts, repositioned=turned))

    def remove(self, sign: Sign) -> None:
        """Remove a sign with its motion and tags. Raises: SignsError: unknown-sign: it is gone."""
        with self.store.writing() as connection:
            _hold(connection, sign)
            connection.execute(delete(SIGN).where(SIGN.c.id == sign.number))

    def copy(self, sign: Sign, other: SignDatabase) -> Sign:
        """Store a sign in another database, bytes and all.

        Raises: SignsError: damaged-sign, unknown-sign; sign-exists: the other has one.
        """
        skeleton = next(s for s in self.skeletons() if s.digest == sign.skeleton_digest)
        return other.add(sign.facts, self.motion(sign), skeleton)

    def _skeleton(self, skeleton: StoredSkeleton) -> int:
        """Return the number of a skeleton, stored first where it is new."""
        wanted = select(SKELETON.c.id).where(SKELETON.c.digest == skeleton.digest)
        with self.store.reading() as connection:
            if (known := connection.execute(wanted).scalar()) is not None:
                return int(known)
        values = {
            "digest": skeleton.digest,
            "name": skeleton.name,
            "joints": list(skeleton.joints),
            "coordinates": list(skeleton.coordinates),
        }
        try:
            with self.store.writing() as connection:
                made = insert(SKELETON).returning(SKELETON.c.id).values(values)
                return int(connection.execute(made).scalar_one())
        except IntegrityError:  # another writer was quicker
            with self.store.reading() as connection:
                return int(connection.execute(wanted).scalar_one())


def _add_tags(connection: Connection, number: int, tags: Iterable[str]) -> None:
    rows = [{"sign": number, "text": tag} for tag in sorted(tags)]
    if rows:
        connection.execute(insert(TAG), rows)


def _hold(connection: Connection, sign: Sign) -> None:
    """Keep others from changing a sign. Raises: SignsError: unknown-sign: it is gone."""
    held = select(SIGN.c.id).where(SIGN.c.id == sign.number).with_for_update()
    if connection.execute(held).first() is None:
        raise SignsError("unknown-sign", f"the sign `{sign.identity}` is gone")


def _exists(store: Store, identity: Identity) -> SignsError:
    return SignsError(
        "sign-exists",
        f"`{store.name}` has a sign `{identity}` of this skeleton already",
        "choose another name, or tell them apart with --variant",
    )


def _damaged(sign: Sign, what: str, remedy: str | None) -> SignsError:
    message = f"the {what} of `{sign.identity}` is damaged: its bytes are not those stored"
    return SignsError("damaged-sign", message, remedy)
