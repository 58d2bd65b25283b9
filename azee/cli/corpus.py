"""`azee corpus`: what a corpus of texts has in it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from azee.cli.console import DONE, FAULT, has_errors, news, show
from azee.cli.outputs import check_outputs, size_of, with_suffix
from azee.cli.text import library_option
from azee.formats import CHART_SUFFIXES, CORPUS_SUFFIXES, writing
from azee_grammar.diagnostic import AZeeError, Diagnostic

if TYPE_CHECKING:
    from azee.corpus.statistics import CorpusStatistics

TABLES = ("rules", "unknown", "arguments", "pairs", "depths")
"""What may be printed; `azee.corpus.tables` has the same names."""


@click.group(short_help="What a corpus has in it.")
def corpus() -> None:
    """Describe a corpus: folders of texts."""


@corpus.command(short_help="Count rules, arguments, depths and what is unknown.")
@click.argument(
    "places",
    nargs=-1,
    required=True,
    metavar="DIR|FILE…",
    type=click.Path(exists=True, path_type=Path),
)
@library_option
@click.option(
    "--table",
    type=click.Choice(TABLES),
    default="rules",
    show_default=True,
    help="What is printed, and what a .csv has: rules by rank, those that are unknown, what "
    "arguments hold, pairs of rules in one utterance, depths.",
)
@click.option(
    "--most", type=click.IntRange(min=1), metavar="N", help="Print the first N rows only."
)
@click.option(
    "-o",
    "outputs",
    metavar="OUT",
    multiple=True,
    type=click.Path(path_type=Path),
    callback=with_suffix(*CORPUS_SUFFIXES),
    help="A file to write instead: the table as .csv, all tables as .json, the rules as a chart: "
    f"{' '.join(CHART_SUFFIXES)}. Repeatable.",
)
@click.option("--quiet", is_flag=True, help="Do not tell how large the corpus is.")
def stats(
    places: Sequence[Path],
    libraries: Sequence[Path],
    table: str,
    most: int | None,
    outputs: Sequence[Path],
    quiet: bool,
) -> int:
    """Count what the utterances of texts apply; a DIR is searched with all folders in it.

    Nothing is evaluated, and rules that no library has are counted too. Of a text with mistakes
    counts what can be read.

    Exit codes: 0 done, 1 mistakes in a text, 2 wrong use.
    """
    from azee.corpus.tables import as_text, summary

    check_outputs(outputs)
    statistics, problems = _read(places, libraries)
    for path in outputs:
        _write(statistics, table, path)
    if not outputs and statistics.applications:
        click.echo(as_text(statistics, table, most))
    show(problems)
    news(summary(statistics), quiet=quiet)
    for path in outputs:
        news(f"wrote {path} ({size_of(path)})", quiet=quiet)
    return FAULT if has_errors(problems) else DONE


def _read(
    places: Sequence[Path], libraries: Sequence[Path]
) -> tuple[CorpusStatistics, Sequence[Diagnostic]]:
    """Return the counts of the texts in some places, and what is wrong with them.

    Raises: AZeeError: cannot-read: a place has no text.
    """
    from azee.corpus.statistics import CorpusStatistics
    from azee.lang.program import load
    from azee_grammar.files import read_source

    programs = []
    problems: list[Diagnostic] = []
    for path in dict.fromkeys(path for place in places for path in _texts(place)):
        try:
            program = load(read_source(path), libraries)
        except AZeeError as error:
            problems += error.diagnostics
            continue
        problems += (found for found in program.found if found not in problems)
        programs.append(program)
    return CorpusStatistics.of(programs), problems


def _texts(place: Path) -> Iterator[Path]:
    from azee_grammar.files import TEXT_SUFFIXES, is_folder

    if not is_folder(place):
        yield place
        return
    found = sorted(path for path in place.rglob("*") if path.suffix in TEXT_SUFFIXES)
    if not found:
        message = f"no text is in the folder `{place}`"
        hint = f"texts have the suffix {' or '.join(TEXT_SUFFIXES)}"
        raise AZeeError(Diagnostic("cannot-read", message, None, help=hint))
    yield from found


def _write(statistics: CorpusStatistics, table: str, path: Path) -> None:
    from azee.corpus.chart import NoChartLibraryError, write_chart
    from azee.corpus.tables import as_csv, as_json
    from azee.export.files import replace_file

    suffix = path.suffix.lower()
    with writing(path):
        if suffix in CHART_SUFFIXES:
            try:
                write_chart(statistics, path)
            except NoChartLibraryError as error:
                hint = "install it with: pip install 'azee[charts]'"
                raise AZeeError(Diagnostic("not-installed", str(error), None, help=hint)) from error
            return
        text = as_csv(statistics, table) if suffix == ".csv" else as_json(statistics)
        with replace_file(path) as file:
            file.write(text.encode())
