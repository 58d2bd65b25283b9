"""A trained model: poses of a hand with all markers, their postures, and whose they are.

The file is a NumPy archive. Its header says where the poses come from and how they were used. The
same recordings and options give the same bytes.
"""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import IO, Any

import numpy as np

from azee.capture.hand import Hand, HandShape
from azee.capture.markers import Floats, MarkersError
from azee.capture.places import Place
from azee.capture.regression import LocalRegression
from azee.capture.root_frame import RootShape
from azee.clip.archive import UNREADABLE
from azee_rig.load import RigError, load_rig
from azee_rig.rig import Rig
from azee_rig.skeleton import frozen

FORMAT, VERSION = "azee-capture-model", 1
_EPOCH = (1980, 1, 1, 0, 0, 0)
_ARRAYS = ("poses", "angles", "root", "offsets", "places", "rotation", "shift", "off_m")


@dataclass(frozen=True, eq=False)
class CaptureModel:
    """What reconstruction needs.

    names: of the M markers, root and digits. poses: (N, M, 3) in the root's frame. angles: (N, C)
    the digits' coordinates in these poses, radians. root: the root's markers. chosen: markers on
    digits that are to be recorded. shape: the person's hand. off_m: (M,) how far reconstruction
    from the chosen markers is off in poses that it has not seen. rate_hz: of the recordings. body,
    side: whose angles they are. provenance: where the poses come from.
    """

    names: tuple[str, ...]
    poses: Floats
    angles: Floats
    root: RootShape
    chosen: tuple[str, ...]
    shape: HandShape
    off_m: Floats
    rate_hz: float
    regression: LocalRegression
    body: str
    side: str
    provenance: Mapping[str, Any]

    def __post_init__(self) -> None:
        for name in ("poses", "angles", "off_m"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.float64))

    @property
    def known(self) -> tuple[str, ...]:
        """Markers that are recorded: those chosen, and the root's."""
        return (*self.chosen, *self.root.names)

    @property
    def digits(self) -> tuple[str, ...]:
        """Markers on digits, in the order of the shape."""
        return tuple(self.shape.markers)

    def columns(self, names: Sequence[str]) -> list[int]:
        """Columns of some markers."""
        return [self.names.index(name) for name in names]

    @cached_property
    def rig(self) -> Rig:
        """The body whose angles the model has. Raises: MarkersError: it does not ship."""
        try:
            return load_rig(self.body)
        except RigError as error:
            raise MarkersError(f"the model is of the body `{self.body}`: {error}") from error

    def hand(self, coupled: bool = False) -> Hand:
        """Return the hand of that body."""
        return Hand(self.rig, self.side, coupled)


def write_model(model: CaptureModel, file: IO[bytes]) -> None:
    """Write a model."""
    header = {
        "format": FORMAT,
        "version": VERSION,
        "names": list(model.names),
        "root": list(model.root.names),
        "chosen": list(model.chosen),
        "places": {name: [p.digit, p.bone] for name, (p, _) in model.shape.markers.items()},
        "rate_hz": model.rate_hz,
        "regression": asdict(model.regression),
        "body": model.body,
        "side": model.side,
        "provenance": dict(model.provenance),
    }
    arrays = dict(
        zip(
            _ARRAYS,
            (
                model.poses, model.angles, model.root.points, model.shape.offsets,
                np.array([at for _, at in model.shape.markers.values()]),
                model.shape.rotation, model.shape.shift, model.off_m,
            ),
            strict=True,
        )
    )  # fmt: skip
    text = json.dumps(header, ensure_ascii=False, allow_nan=False).encode()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in {"header": np.frombuffer(text, dtype=np.uint8), **arrays}.items():
            data = io.BytesIO()
            np.lib.format.write_array(data, np.ascontiguousarray(array), allow_pickle=False)
            entry = zipfile.ZipInfo(f"{name}.npy", _EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data.getvalue())


def read_model(path: str | Path) -> CaptureModel:
    """Read a model. Raises: MarkersError: it is none, or damaged. OSError: it cannot be read."""
    with Path(path).open("rb") as file:
        try:
            with np.load(file, allow_pickle=False) as packed:
                if "header" not in packed:
                    raise MarkersError(f"`{path}` is no model that azee wrote")
                header = json.loads(packed["header"].tobytes())
                if not isinstance(header, dict) or header.get("format") != FORMAT:
                    raise MarkersError(f"`{path}` is no model that azee wrote")
                if header.get("version") != VERSION:
                    raise MarkersError(
                        f"`{path}` is a model of version {header.get('version')}; this azee reads "
                        f"version {VERSION}"
                    )
                return _model(header, {name: packed[name] for name in _ARRAYS})
        except MarkersError:
            raise
        except UNREADABLE as error:
            raise MarkersError(
                f"`{path}` is no model that azee wrote, or is damaged",
                "`azee capture train` writes models",
            ) from error


def _model(header: Mapping[str, Any], arrays: Mapping[str, Floats]) -> CaptureModel:
    """Return a stored model. Raises: one of `UNREADABLE`: something does not fit."""
    places = {name: Place(digit, bone) for name, (digit, bone) in header["places"].items()}
    names = tuple(header["names"])
    sizes = {
        "poses": (len(arrays["poses"]), len(names), 3),
        "angles": (len(arrays["poses"]), arrays["angles"].shape[1]),
        "root": (len(header["root"]), 3),
        "places": (len(places), 3),
        "offsets": (15, 3),
        "off_m": (len(names),),
    }
    for name, size in sizes.items():
        if arrays[name].shape != size or not np.isfinite(arrays[name]).all():
            raise ValueError(name)
    markers = {n: (p, at) for (n, p), at in zip(places.items(), arrays["places"], strict=True)}
    return CaptureModel(
        names,
        arrays["poses"],
        arrays["angles"],
        RootShape(tuple(header["root"]), arrays["root"]),
        tuple(header["chosen"]),
        HandShape(arrays["offsets"], markers, arrays["rotation"], arrays["shift"]),
        arrays["off_m"],
        float(header["rate_hz"]),
        LocalRegression(**header["regression"]),
        str(header["body"]),
        str(header["side"]),
        header["provenance"],
    )
