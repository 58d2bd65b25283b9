"""Films: the frames of a clip as MP4 or WebM, encoded by PyAV, which the extra `film` installs.

MP4 has H.264, WebM has VP9. Both are 4:2:0, tagged and converted as BT.709, so that players show
the colours of the pictures. A transparent film is a WebM with an alpha channel. Chroma is shared by
two pixels each way, so odd sizes grow by one. The encoders use a fixed number of threads and write
neither their version nor a date, so that the same clip gives the same film.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

from azee.clip.clip import Clip
from azee.clip.resample import at_rate
from azee.export.files import replace_path
from azee.export.pictures.scene import Look, Scene
from azee_rig.rig import Rig

BT709 = 1
"""Number of BT.709 as primaries, transfer and matrix in H.264, VP9 and their containers."""
LIMITED = 1
"""Luma from 16 to 235, as films have it."""
CODECS: dict[str, tuple[str, dict[str, str]]] = {
    ".mp4": ("libx264", {"crf": "21", "preset": "medium", "threads": "2"}),
    ".webm": (
        "libvpx-vp9",
        {"crf": "30", "b": "0", "deadline": "good", "cpu-used": "5", "row-mt": "1", "threads": "2"},
    ),
}
CONTAINERS = {
    ".mp4": {"movflags": "+faststart", "fflags": "+bitexact"},
    ".webm": {"fflags": "+bitexact"},
}


class NoEncoderError(Exception):
    """PyAV is not installed."""


def encoder() -> Any:
    """Return PyAV. Raises: NoEncoderError: it is not installed."""
    try:
        import av
    except ImportError as error:
        raise NoEncoderError("films are encoded by PyAV, which is not installed") from error
    return av


def even(size: tuple[int, int]) -> tuple[int, int]:
    """Return the size that a film of this size has: even both ways."""
    return size[0] + size[0] % 2, size[1] + size[1] % 2


def write_film(
    clip: Clip,
    rig: Rig,
    path: str | Path,
    look: Look | None = None,
    *,
    fps: float = 30.0,
    progress: Callable[[int, int], None] | None = None,
) -> None:
    """Write a film of a clip, sampled at a rate of its own.

    Args: progress: called with the frames that are done, and all of them.
    Raises: NoEncoderError. ValueError: the format has no transparency. KeyError: no such camera.
        OSError.
    """
    av = encoder()
    suffix = Path(path).suffix.lower()
    look = look or Look()
    look = replace(look, size=even(look.size))
    if look.transparent and suffix != ".webm":
        raise ValueError("MP4 has no transparency; WebM has")
    scene = Scene(at_rate(clip, fps, rig.coordinates), rig, look)
    with (
        replace_path(path) as part,
        av.open(
            str(part), "w", format=suffix[1:], container_options=CONTAINERS[suffix]
        ) as container,
    ):
        stream = _stream(container, suffix, look, fps)
        for packet in _packets(av, stream, scene, progress):
            container.mux(packet)


def _stream(container: Any, suffix: str, look: Look, fps: float) -> Any:
    codec, options = CODECS[suffix]
    rate = Fraction(fps).limit_denominator(1001)
    stream = container.add_stream(codec, rate=rate, options=dict(options))
    stream.width, stream.height = look.size
    stream.pix_fmt = "yuva420p" if look.transparent else "yuv420p"
    context = stream.codec_context
    context.color_primaries = context.color_trc = context.colorspace = BT709
    context.color_range = LIMITED
    context.flags |= 1 << 23  # AV_CODEC_FLAG_BITEXACT: no version in the stream
    return stream


def _packets(
    av: Any, stream: Any, scene: Scene, progress: Callable[[int, int], None] | None
) -> Iterator[Any]:
    count = len(scene.clip.times)
    for number, pixels in enumerate(scene.frames()):
        frame = av.VideoFrame.from_ndarray(
            pixels, format="rgba" if pixels.shape[2] == 4 else "rgb24"
        )
        frame = frame.reformat(format=stream.pix_fmt, dst_colorspace=BT709, dst_color_range=LIMITED)
        frame.pts = number
        yield from stream.encode(frame)
        if progress:
            progress(number + 1, count)
    yield from stream.encode()
