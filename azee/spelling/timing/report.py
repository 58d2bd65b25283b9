"""The evaluation of a timing model as files: JSON, tables for people, figures."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from azee.spelling.timing.drawn import drawn_repetitions, drawn_words
from azee.spelling.timing.evaluation import Evaluation, evaluate
from azee.spelling.timing.features import CHOSEN, FEATURES
from azee.spelling.timing.figures import write_figures
from azee.spelling.timing.letter_poses import asl_poses
from azee.spelling.timing.model import DRAWN, TimingModel
from azee.spelling.timing.published import Style
from azee.spelling.timing.validation import SCHEMES


def evaluate_model(
    model: TimingModel, style: Style = "normal", told: Callable[[str], None] = lambda _: None
) -> Evaluation:
    """Measure a model; one of drawn words with the other style and the repeated words too."""
    if model.origin != DRAWN:
        repeated = [word for word in model.words if _is_repeated(word.word, model)]
        return evaluate(model, asl_poses(), style=style, repeated=repeated, told=told)
    other: Style = "careful" if style == "normal" else "normal"
    return evaluate(
        model,
        asl_poses(),
        style=style,
        others={other: drawn_words(style=other)},
        repeated=drawn_repetitions(),
        told=told,
    )


def _is_repeated(name: str, model: TimingModel) -> bool:
    return len({word.spelling for word in model.words if word.word == name}) > 1


def write_report(evaluation: Evaluation, folder: Path) -> Sequence[Path]:
    """Write evaluation.json, evaluation.md and the figures. Raises: OSError."""
    data, page = folder / "evaluation.json", folder / "evaluation.md"
    data.write_text(
        json.dumps(evaluation.to_json(), indent=2, ensure_ascii=False) + "\n", encoding="utf-8"
    )
    page.write_text("\n".join(page_lines(evaluation)) + "\n", encoding="utf-8")
    return [data, page, *write_figures(evaluation, folder)]


def page_lines(e: Evaluation) -> Iterator[str]:
    """Yield the tables of an evaluation in Markdown."""
    yield f"Times {e.origin}."
    yield ""
    yield from _hold_table(e)
    yield ""
    yield from _feature_table(e)
    yield ""
    yield from _word_table(e)
    yield ""
    yield from _fact_table(e)


def _hold_table(e: Evaluation) -> Iterator[str]:
    yield "| holds | accuracy, % | | | mean error, ms | | |"
    yield "|---|---|---|---|---|---|---|"
    yield f"| | {' | '.join(SCHEMES)} | {' | '.join(SCHEMES)} |"
    for name, by in e.holds.items():
        accuracy = " | ".join(f"{100 * by[scheme].accuracy:.1f}" for scheme in SCHEMES)
        error = " | ".join(f"{1000 * by[scheme].error_s:.1f}" for scheme in SCHEMES)
        yield f"| {name} | {accuracy} | {error} |"
    for constant, errors in e.constant.items():
        accuracy, error = f"{100 * errors.accuracy:.1f}", f"{1000 * errors.error_s:.1f}"
        yield f"| {constant} | | | {accuracy} | | | {error} |"
    yield ""
    yield (
        f"On held-out words, the error of ridge regression is {e.gain:.1f} times smaller than that "
        "of the best constant model."
    )


def _feature_table(e: Evaluation) -> Iterator[str]:
    """Table 4.2, with what each feature adds to those before it; figures 4.4 and 4.5."""
    heads = " | ".join(f"{scheme}, %" for scheme in SCHEMES)
    yield f"| table 4.2: naive Bayes with features up to | {heads} |"
    yield "|---|" + "---|" * len(SCHEMES)
    for n, name in enumerate(FEATURES):
        row = " | ".join(f"{100 * e.by_feature[FEATURES][s][n].accuracy:.1f}" for s in SCHEMES)
        yield f"| {n + 1} {name} | {row} |"
    row = " | ".join(f"{100 * e.by_feature[CHOSEN][s][-1].accuracy:.1f}" for s in SCHEMES)
    yield f"| all but shape | {row} |"


def _word_table(e: Evaluation) -> Iterator[str]:
    yield "| table 4.3: whole words | mean error, ms |"
    yield "|---|---|"
    for name, error_s in e.words_s.items():
        yield f"| {name} | {1000 * error_s:.1f} |"


def _fact_table(e: Evaluation) -> Iterator[str]:
    yield "| published | theirs | ours | |"
    yield "|---|---|---|---|"
    for fact in e.facts:
        reason = f": {fact.reason}" if fact.reason else ""
        yield f"| {fact.name} | {fact.theirs} | {fact.ours} | {fact.verdict}{reason} |"
