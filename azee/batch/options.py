"""What a batch makes of each text: how it is solved, what varies, and in which formats."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from azee.compilation import Hand
    from azee.motion.keys.rest import Rest
    from azee.motion.timing.performed import Timing


@dataclass(frozen=True, slots=True)
class Options:
    """The options of a batch; all that is varied has one value at least.

    formats: suffixes, of `azee.formats.WRITERS`. hands: of the signer; the left-handed clip is the
    mirror image of the right-handed one. seeds: of breathing, blinking and sway; None is that of
    the score. speeds: factors by which the finished clip is faster. cameras: of formats that show
    the body from somewhere; none if no format does. renderer: who draws films, of
    `azee.export.pictures.renderer.CHOICES`. The others are those of `azee.compile`.
    """

    formats: tuple[str, ...]
    hands: tuple[Hand, ...] = ("right",)
    seeds: tuple[int | None, ...] = (None,)
    speeds: tuple[float, ...] = (1.0,)
    cameras: tuple[str, ...] = ()
    renderer: str = "software"
    fps: float = 30.0
    rest: Rest = "hanging"
    timing: Timing | None = None
    tempo: float = 1.0
    precise: bool = False
    life: bool = True

    def as_json(self) -> dict[str, Any]:
        """Return them as plain data."""
        return asdict(self)
