"""`azee elan`: ELAN files beside each other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from azee.cli.console import DONE, MISSED, show_json
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.corpus.agreement import Spread, TierAgreement
    from azee.corpus.annotations import Annotation


@click.group(short_help="Compare ELAN files.")
def elan() -> None:
    """Work with ELAN files; needs the extra `elan`."""


@elan.command(short_help="Offsets of annotations between two files.")
@click.argument("first", metavar="A.eaf", type=click.Path(path_type=Path))
@click.argument("second", metavar="B.eaf", type=click.Path(path_type=Path))
@click.option(
    "--tier",
    "tiers",
    metavar="NAME[=NAME]",
    multiple=True,
    help="A tier of A, and the one of B if its name is another; repeatable. By default all that "
    "both have.",
)
@click.option("--align", is_flag=True, help="First move B by the mean offset of all starts.")
@click.option("--pairs", is_flag=True, help="Also list every pair, and what only one file has.")
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text")
def compare(
    first: Path, second: Path, tiers: Sequence[str], align: bool, pairs: bool, form: str
) -> int:
    """Compare the times of annotations: of a score (A) with a recording (B), say.

    Annotations of one text are paired in order. Offsets are B minus A, in seconds; after ± is the
    standard deviation. Overlap is the common time by the time of both.

    Exit codes: 0 done, 1 a file cannot be read, 2 wrong use, 3 nothing could be paired.
    """
    from azee.corpus.agreement import aligned, compared

    a, b = _read(first), _read(second)
    found, moved_s = compared(a, b, _chosen(tiers, a, b, first, second)), 0.0
    if align:
        found, moved_s = aligned(found)
    if form == "json":
        show_json({"moved_s": moved_s, "tiers": [_as_json(tier) for tier in found]})
    else:
        if align:
            click.echo(f"B is moved by {moved_s:+.3f} s")
        click.echo("\n".join(_lines(found, pairs=pairs)))
    return DONE if any(tier.pairs for tier in found) else MISSED


def _read(path: Path) -> Mapping[str, Sequence[Annotation]]:
    from azee.corpus.annotations import NoElanLibraryError, NotElanError, read_tiers

    try:
        return read_tiers(path)
    except NoElanLibraryError as error:
        hint = "install it with: pip install 'azee[elan]'"
        raise AZeeError(Diagnostic("not-installed", str(error), None, help=hint)) from error
    except NotElanError as error:
        raise AZeeError(Diagnostic("cannot-read", str(error), None)) from error
    except FileNotFoundError as error:
        message = f"there is no file `{path}`"
        raise AZeeError(Diagnostic("cannot-read", message, None)) from error
    except OSError as error:
        reason = (error.strerror or "it cannot be opened").lower()
        message = f"cannot read `{path}`: {reason}"
        raise AZeeError(Diagnostic("cannot-read", message, None)) from error


def _chosen(
    tiers: Sequence[str],
    a: Mapping[str, Sequence[Annotation]],
    b: Mapping[str, Sequence[Annotation]],
    first: Path,
    second: Path,
) -> dict[str, str]:
    """Return the tiers to compare. Raises: click.UsageError: a file has none of that name."""
    chosen = {}
    for text in tiers:
        name, _, other = text.partition("=")
        chosen[name] = other or name
    for names, known, path in ((chosen, a, first), (chosen.values(), b, second)):
        for name in names:
            if name not in known:
                raise click.UsageError(f"`{path}` has no tier `{name}`; it has {_listed(known)}")
    if not chosen and not set(a) & set(b):
        raise click.UsageError(
            f"no tier has the same name in both: `{first}` has {_listed(a)}; `{second}` has "
            f"{_listed(b)}; name them with --tier A=B"
        )
    return chosen


def _listed(names: Mapping[str, object]) -> str:
    return ", ".join(f"`{name}`" for name in names) or "none"


def _lines(found: Sequence[TierAgreement], *, pairs: bool) -> Iterator[str]:
    head = ("tier", "pairs", "only A", "only B", "start s", "end s", "longer ×", "overlap")
    rows = [head, *(_row(tier) for tier in found)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = (f"{c:>{w}}" for c, w in zip(row[1:], widths[1:], strict=True))
        yield "  ".join((f"{row[0]:<{widths[0]}}", *cells))
    for tier in found if pairs else ():
        yield ""
        yield _title(tier)
        for pair in tier.pairs:
            yield (
                f"  {pair.first.text}: start {pair.start_s:+.3f} s, end {pair.end_s:+.3f} s, "
                f"overlap {pair.overlap:.2f}"
            )
        yield from (f"  only A: {a.text} at {a.start_s:.3f} s" for a in tier.only_first)
        yield from (f"  only B: {b.text} at {b.start_s:.3f} s" for b in tier.only_second)


def _row(tier: TierAgreement) -> tuple[str, ...]:
    counts = (len(tier.pairs), len(tier.only_first), len(tier.only_second))
    return (
        _title(tier),
        *map(str, counts),
        _spread(tier.start_s, signed=True),
        _spread(tier.end_s, signed=True),
        _spread(tier.longer),
        _spread(tier.overlap),
    )


def _title(tier: TierAgreement) -> str:
    same = tier.first_tier == tier.second_tier
    return tier.first_tier if same else f"{tier.first_tier} = {tier.second_tier}"


def _spread(spread: Spread, *, signed: bool = False) -> str:
    if spread.mean is None or spread.deviation is None:
        return "–"
    return f"{spread.mean:{'+' if signed else ''}.2f} ± {spread.deviation:.2f}"


def _as_json(tier: TierAgreement) -> dict[str, Any]:
    return {
        "first": tier.first_tier,
        "second": tier.second_tier,
        "start_s": asdict(tier.start_s),
        "end_s": asdict(tier.end_s),
        "longer": asdict(tier.longer),
        "overlap": asdict(tier.overlap),
        "pairs": [
            {
                "text": pair.first.text,
                "first": {"start_s": pair.first.start_s, "end_s": pair.first.end_s},
                "second": {"start_s": pair.second.start_s, "end_s": pair.second.end_s},
                "overlap": pair.overlap,
            }
            for pair in tier.pairs
        ],
        "only_first": [asdict(annotation) for annotation in tier.only_first],
        "only_second": [asdict(annotation) for annotation in tier.only_second],
    }
