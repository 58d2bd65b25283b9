"""What a study shows: a folder of clips, named by a manifest beside them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from azee.spelling.study.design import Design, DesignError

FORMAT, VERSION = "azee-spelling-study", 1
NAME = "manifest.json"
MEDIA = {".mp4": "video/mp4", ".webm": "video/webm", ".gif": "image/gif", ".png": "image/png"}
"""What browsers show, by suffix."""
SAMPLE = "sample"


class ManifestError(ValueError):
    """A folder cannot be shown; the message says what is missing."""


@dataclass(frozen=True, slots=True)
class Manifest:
    """The clips of a study.

    design: what is compared. clips: file of each word and type. sample: a clip that the
    instructions show. language: what is signed, by its name.

    Raises: ManifestError: a clip is missing, of no known kind, or outside of the folder.
    """

    folder: Path
    title: str
    language: str
    design: Design
    clips: Mapping[tuple[str, str], Path]
    sample: Path | None

    def __post_init__(self) -> None:
        for word in self.design.words:
            for kind in self.design.types:
                path = self.clips.get((word, kind))
                if path is None:
                    raise ManifestError(f"there is no clip of `{word}` as `{kind}`")
                _check(self.folder, path)
        if self.sample is not None:
            _check(self.folder, self.sample)


def _check(folder: Path, path: Path) -> None:
    if path.suffix.lower() not in MEDIA:
        raise ManifestError(f"`{path.name}` is none of {' '.join(MEDIA)}")
    if not path.resolve().is_relative_to(folder.resolve()):
        raise ManifestError(f"`{path}` lies outside of the study's folder")
    if not path.is_file():
        raise ManifestError(f"there is no file `{path}`")


def read_manifest(folder: str | Path) -> Manifest:
    """Read the manifest of a folder. Raises: ManifestError. OSError: it cannot be read."""
    folder = Path(folder)
    try:
        data = json.loads((folder / NAME).read_text(encoding="utf-8"))
        if not isinstance(data, dict) or data.get("format") != FORMAT:
            raise ManifestError(f"`{folder / NAME}` is no manifest of a study")
        if data.get("version") != VERSION:
            raise ManifestError(f"`{folder / NAME}` is of version {data.get('version')}")
        clips = {
            (word, kind): folder / name
            for word, by_type in data["clips"].items()
            for kind, name in by_type.items()
        }
        return Manifest(
            folder,
            str(data["title"]),
            str(data["language"]),
            Design(
                tuple(data["types"]),
                tuple(data["words"]),
                int(data["seed"]),
                bool(data["no_difference"]),
            ),
            clips,
            folder / data["sample"] if data.get("sample") else None,
        )
    except ManifestError:
        raise
    except DesignError as error:
        raise ManifestError(f"`{folder / NAME}`: {error}") from error
    except KeyError as error:
        raise ManifestError(f"`{folder / NAME}` has no entry {error}") from error
    except (AttributeError, TypeError, ValueError) as error:
        raise ManifestError(f"`{folder / NAME}` is damaged: {error}") from error


def manifest_of_names(
    folder: str | Path, *, seed: int, title: str, language: str, no_difference: bool
) -> Manifest:
    """Make a manifest of a folder whose files are called `WORD-TYPE.mp4`, and `sample.mp4`.

    Raises: ManifestError: no file is called so, or a word lacks a type. OSError.
    """
    folder = Path(folder)
    clips, sample = {}, None
    for path in sorted(folder.iterdir()):
        word, dash, kind = path.stem.rpartition("-")
        if path.suffix.lower() not in MEDIA:
            continue
        if path.stem == SAMPLE:
            sample = path
        elif dash and word and kind:
            clips[word.upper(), kind] = path
    if not clips:
        raise ManifestError(f"no file in `{folder}` is called like `WORD-TYPE.mp4`")
    words = tuple(dict.fromkeys(word for word, _ in clips))
    types = tuple(dict.fromkeys(kind for _, kind in clips))
    try:
        design = Design(types, words, seed, no_difference)
    except DesignError as error:
        raise ManifestError(f"`{folder}`: {error}") from error
    return Manifest(folder, title, language, design, clips, sample)


def manifest_json(manifest: Manifest) -> dict[str, Any]:
    """Return what `read_manifest` reads."""
    design = manifest.design
    return {
        "format": FORMAT,
        "version": VERSION,
        "title": manifest.title,
        "language": manifest.language,
        "seed": design.seed,
        "no_difference": design.no_difference,
        "types": list(design.types),
        "words": list(design.words),
        "sample": manifest.sample.name if manifest.sample else None,
        "clips": {
            word: {kind: manifest.clips[word, kind].name for kind in design.types}
            for word in design.words
        },
    }
