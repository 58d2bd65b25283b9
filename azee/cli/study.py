"""`azee study`: pages on which people compare animations, and what their answers say."""

from __future__ import annotations

import json
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import click

from azee.cli.console import DONE, news
from azee_grammar.diagnostic import AZeeError, Diagnostic

LOOPBACK = "127.0.0.1"


@click.group("study", short_help="Which of several animations people find most natural.")
def study() -> None:
    """Let people compare clips of spelled words, and analyse their answers."""


@study.command(short_help="Name the clips of a folder.")
@click.argument("folder", metavar="FOLDER", type=click.Path(path_type=Path))
@click.option("--seed", type=click.IntRange(0), default=1, show_default=True,
              help="Of the order of pages.")  # fmt: skip
@click.option("--title", default="Fingerspelling", show_default=True)
@click.option("--language", default="American Sign Language", show_default=True)
@click.option("--no-difference", is_flag=True, help="Offer `I see no difference` as an answer.")
def manifest(folder: Path, seed: int, title: str, language: str, no_difference: bool) -> int:
    """Write FOLDER/manifest.json for clips called `WORD-TYPE.mp4`, and `sample.mp4`.

    Every word needs a clip of every type, such as `GUITAR-variable.mp4`. Clips may be MP4, WebM,
    GIF or PNG.
    """
    from azee.export.files import replace_file
    from azee.formats import writing
    from azee.spelling.study.manifest import NAME, manifest_json, manifest_of_names

    with _refused(folder):
        made = manifest_of_names(
            folder, seed=seed, title=title, language=language, no_difference=no_difference
        )
    text = json.dumps(manifest_json(made), indent=2, ensure_ascii=False)
    with writing(folder / NAME), replace_file(folder / NAME) as file:
        file.write(f"{text}\n".encode())
    design = made.design
    news(
        f"{len(design.words)} words as {', '.join(design.types)}: {design.page_count} pages a "
        f"participant; wrote {folder / NAME}"
    )
    return DONE


@study.command(short_help="Show the pages on this machine.")
@click.argument("folder", metavar="FOLDER", type=click.Path(path_type=Path))
@click.option(
    "--answers", "answers_file", metavar="A.sqlite", type=click.Path(path_type=Path),
    help="Where answers are kept; by default FOLDER/answers.sqlite.",
)  # fmt: skip
@click.option("--port", type=click.IntRange(0, 65535), default=8048, show_default=True,
              help="0 takes any that is free.")  # fmt: skip
def serve(folder: Path, answers_file: Path | None, port: int) -> int:
    """Show the study of FOLDER to the browsers of this machine, until Ctrl-C.

    An answer is on disk before its next page is shown. Whoever comes back, after whatever was
    stopped, goes on where they were.
    """
    from azee.spelling.study.answers import Answers
    from azee.spelling.study.manifest import read_manifest
    from azee.spelling.study.sample_size import sentence

    with _with_extra():
        import uvicorn

        from azee.spelling.study.server import study_app

    path = answers_file or folder / "answers.sqlite"
    with _refused(folder):
        shown = read_manifest(folder)
    with _refused(path):
        answers = Answers.create(path, shown.design)
    try:
        listening = socket.create_server((LOOPBACK, port))
    except OSError as error:
        message = f"port {port} is taken: `--port 0` takes one that is free"
        raise click.BadParameter(message, param_hint="'--port'") from error
    server = uvicorn.Server(
        uvicorn.Config(study_app(shown, answers), log_level="warning", server_header=False)
    )
    news(
        f"the study is at http://{LOOPBACK}:{listening.getsockname()[1]}/ (Ctrl-C ends it)\n"
        f"answers are kept in {path}, {len(answers.participants())} participants so far\n"
        f"{sentence(len(shown.design.words))}"
    )
    server.run(sockets=[listening])
    return DONE


@study.command(short_help="What the answers say.")
@click.argument("answers_file", metavar="A.sqlite", type=click.Path(path_type=Path))
@click.option(
    "-o", "folder", metavar="OUT", required=True, type=click.Path(path_type=Path),
    help="Write report.html, its plots, analysis.json and choices.csv; made if it is not there.",
)  # fmt: skip
def analyse(answers_file: Path, folder: Path) -> int:
    """Analyse the answers of a study: pairs, shares, Bradley–Terry, ANOVA and t tests."""
    from azee.formats import writing
    from azee.spelling.study.answers import Answers

    with _with_extra():
        from azee.spelling.study.report import write_report

    with _refused(answers_file):
        answers = Answers.open(answers_file)
        if not any(answers.choices(person) for person in answers.participants()):
            message = f"nobody has chosen anything yet in `{answers_file}`"
            raise AZeeError(Diagnostic("not-a-study", message, None))
    with writing(folder):
        folder.mkdir(exist_ok=True)
        found, written = write_report(answers, folder)
    news(
        f"{len(found.participants)} participants, {found.choice_count:g} choices\n"
        + "\n".join(f"wrote {path}" for path in written)
    )
    return DONE


@contextmanager
def _refused(path: Path) -> Iterator[None]:
    """Turn what is wrong with a folder or a file of answers into a diagnostic."""
    from azee.clips import reading
    from azee.spelling.study.answers import AnswersError
    from azee.spelling.study.manifest import ManifestError

    try:
        with reading(path):
            yield
    except (ManifestError, AnswersError) as error:
        raise AZeeError(Diagnostic("not-a-study", str(error), None)) from error


@contextmanager
def _with_extra() -> Iterator[None]:
    """Turn a missing library into a diagnostic. Raises: AZeeError: not-installed."""
    try:
        yield
    except ModuleNotFoundError as error:
        known = ("starlette", "uvicorn", "jinja2", "matplotlib", "python_multipart")
        if (error.name or "").partition(".")[0] not in known:
            raise
        message = f"studies need {error.name}"
        remedy = "install it with: pip install 'azee[study]'"
        raise AZeeError(Diagnostic("not-installed", message, None, help=remedy)) from error
