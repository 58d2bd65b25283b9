"""The data card of a data set, from its manifest."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from azee.batch.version import installed_version

CARD = """\
# A synthetic data set of signing

{clips:,} clips of {texts} utterances: {variations}. {hours:.2f} hours of movement, {files:,} files,
{size:.1f} MB. Made by azee {version}.

## What it is

Each utterance was written in AZee, a formal description of sign languages. A solver makes a body
perform it. So the movement, the text and the times of all signs agree exactly. No person was
recorded, and no corpus was used.

| | |
|---|---|
| utterances | {texts}, in `texts.jsonl`: `text` (AZee), `gloss`, `meaning` (English) |
| bodies | {bodies} |
| cameras | {cameras} |
| speeds | {speeds} |
| frames a second | {fps} |
| formats | {formats} |
| tasks that failed | {failed} |

`manifest.jsonl` has a line for each clip and camera: text, labels with their times, files, and how
well the constraints of the text are met.

## How well the texts are met

{constraints:,} constraints over all bodies: {met:,} met ({met_share:.1%}), {eased:,} eased for
comfort inside 1 cm and 5°, {missed:,} missed.

{outcomes}

## What it is for, and what not

It is for training and testing programs that find bodies, hands and signs in pictures, or that
translate poses. It shows what a description says and nothing that only people do.

- The forms of signs and rules are those that publications show, or ours; `azee rules NAME` says
  which. No deaf signer has judged the utterances. Do not teach from them, and do not measure with
  them how well a program understands a sign language.
- The meanings in English are glosses of the rules, not translations by interpreters.
- Utterances are combinations of few signs. Split by `text`, never by clip: clips of one text
  differ only in body, camera and speed.

## Licence

Texts, bodies and clips are dedicated to the public domain (CC0 1.0). The rules belong to azee
(Apache 2.0); its NOTICE names the publications that they follow.

## Made again

    python examples/dataset/make.py -o OUT

The same version of azee gives the same files.
"""


def data_card(manifest: Path) -> str:
    """Return a data card in Markdown. The files are beside the manifest."""
    lines = manifest.read_text(encoding="utf-8").splitlines()
    rows = [json.loads(line) for line in lines]
    sound = [row for row in rows if not row["error"]]
    folder = manifest.parent
    files = {name for row in sound for name in row["files"].values()}
    once = {(row["name"], row["body"]): row for row in sound}
    counts = {
        name: sum(int(row[name]) for row in once.values()) for name in ("met", "eased", "missed")
    }
    constraints = sum(counts.values())
    varied = {name: _values(sound, name) for name in ("body", "camera", "speed", "hand")}
    varying = [f"{len(values)} × {name}" for name, values in varied.items() if len(values) > 1]
    return CARD.format(
        clips=len(sound),
        texts=len({row["name"] for row in rows}),
        variations=", ".join(varying) or "one of each",
        hours=sum(row["duration_s"] for row in sound) / 3600,
        files=len(files),
        size=sum((folder / name).stat().st_size for name in files) / 1e6,
        version=installed_version(),
        bodies=", ".join(varied["body"]),
        cameras=", ".join(varied["camera"]),
        speeds=", ".join(varied["speed"]),
        fps=", ".join(_values(sound, "fps")),
        formats=", ".join(sorted({Path(name).suffix for name in files})),
        failed=sum(bool(row["error"]) for row in rows),
        constraints=constraints,
        met_share=counts["met"] / max(1, constraints),
        outcomes=_outcomes(once.values()),
        **counts,
    )


def _values(rows: Iterable[Mapping[str, Any]], name: str) -> list[str]:
    found = dict.fromkeys(row[name] for row in rows)
    return [f"{value:g}" if isinstance(value, float) else str(value) for value in found]


def _outcomes(rows: Iterable[Mapping[str, Any]]) -> str:
    """Return a table: constraints by body."""
    counts: Counter[tuple[str, str]] = Counter()
    for row in rows:
        for name in ("met", "eased", "missed"):
            counts[row["body"], name] += row[name]
    bodies = dict.fromkeys(body for body, _ in counts)
    lines = ["| body | met | eased | missed |", "|---|---|---|---|"]
    for body in bodies:
        values = (f"{counts[body, name]:,}" for name in ("met", "eased", "missed"))
        lines.append(f"| {body} | {' | '.join(values)} |")
    return "\n".join(lines)
