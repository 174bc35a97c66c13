"""The Lab and the lessons' figures in notebooks of Jupyter and marimo.

Needs anywidget, which the extra ``widget`` brings. The visitor's browser computes and draws, as on the page; the kernel only sends
the pair and receives reports.

    from bimodal_stereo import sample
    from bimodal_stereo.widget import Figure, Lab

    Figure("lambert")
    scene = sample("bust", "window", angles={"beta": 30})
    Lab(scene.image, scene.depth, start="identity")
"""

from __future__ import annotations

from functools import lru_cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any, Mapping, Optional, Union

import numpy as np

from . import _inputs
from ._errors import BimodalError
from ._types import ColorImage, DepthMap, StepReport

try:
    from anywidget import AnyWidget
    from traitlets import Bool, Dict, Unicode
except ImportError as reason:
    raise ImportError("bimodal_stereo.widget needs anywidget: pip install anywidget") from reason

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._inputs import Options
    from ._types import Pixels

__all__ = ["Figure", "Lab"]

# Names for the browser, with the files that have them.
FILES = {"stereo-thread": "stereo-thread.js", "figure-thread": "figure-thread.js", "wasm": "bimodal_stereo_bg.wasm.gz"}


@lru_cache
def content(name: str) -> bytes:
    """A file for the browser, which ``npm run build`` puts beside this module."""
    try:
        return (files(__package__) / "_widget" / name).read_bytes()
    except FileNotFoundError as error:
        message = "widget: this installation has no files for a browser; run `npm run build` in the checkout, then install the package again"
        raise BimodalError("missing", message, "widget") from error


def camel(name: str) -> str:
    """The JavaScript spelling of a member."""
    first, *others = name.rstrip("_").split("_")
    return first + "".join(other.capitalize() for other in others)


def spelled(value: Any) -> Any:
    """Members by their JavaScript names, without those that are not given; small arrays as lists."""
    if isinstance(value, Mapping):
        return {camel(name): spelled(member) for name, member in value.items() if member is not None}
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def packed(view: Mapping[str, Any]) -> dict[str, Any]:
    """A view whose arrays are sent as bytes."""
    made: dict[str, Any] = {}
    for name, value in view.items():
        if isinstance(value, np.ndarray):
            made[name] = {"type": value.dtype.name, "bytes": value.tobytes()}
        elif value is not None:
            made[name] = spelled(value)
    return made


def numbered(report: Mapping[str, Any]) -> dict[str, Any]:
    """A report in which unknown numbers are NaN again, because JSON has no NaN."""

    def known(members: Mapping[str, Any], *names: str) -> dict[str, Any]:
        return {name: np.nan if members[name] is None else members[name] for name in names}

    energy = report["energy"]
    return {**report, **known(report, "rotationChange", "overlap", "inliers", "residual"), "energy": known(energy, *energy)}


class _Element(AnyWidget):
    """What both widgets share; ``error`` has ``code``, ``field`` and ``message`` of the last failure."""

    _tag = Unicode().tag(sync=True)
    error = Dict().tag(sync=True)

    def __init__(self, **traits: Any) -> None:
        # The files are set here and not in the class, so that an installation without them fails only when a widget is
        # made.
        super().__init__(_esm=content("widget.js").decode(), **traits)
        self.on_msg(self._answer)

    def _answer(self, _: Any, wanted: Any, __: Any) -> None:
        """Sends the browser its files, which it requests once for each page."""
        if wanted == {"wants": "files"}:
            self.send({"files": list(FILES)}, buffers=[content(name) for name in FILES.values()])


class Figure(_Element):
    """The live figure of a lesson, such as "lambert", "pixel" or "failure".

    ``state``: its controls as in the address of the lessons, such as "noise=2&light=window"; follows the reader's changes. ``result``: the
    ``numbers`` and ``words`` under the figure.
    """

    lesson = Unicode().tag(sync=True)
    state = Unicode().tag(sync=True)
    result = Dict().tag(sync=True)

    def __init__(self, lesson: str, state: str = "") -> None:
        super().__init__(_tag="bimodal-figure", lesson=lesson, state=state)


class Lab(_Element):
    """A run with its image, normals, light, both surfaces and curves.

    ``image``, ``depth`` and ``options`` are those of ``Estimator``. ``status`` is that of the report; ``paused`` can be
    set, and ``charts`` tells whether surfaces and curves are shown. The options ``workers`` are the browser's own.
    """

    _pair = Dict().tag(sync=True)
    _options = Dict().tag(sync=True)
    _report = Dict().tag(sync=True)
    status = Unicode().tag(sync=True)
    paused = Bool().tag(sync=True)
    charts = Bool().tag(sync=True)

    def __init__(
        self,
        image: Union[ColorImage, Pixels],
        depth: Union[DepthMap, Pixels],
        *,
        paused: bool = False,
        charts: bool = True,
        **options: Unpack[Options],
    ) -> None:
        pair = {"image": packed(_inputs.image(image)), "depth": packed(_inputs.depth(depth))}
        plain = spelled(_inputs.keywords(options))
        super().__init__(_tag="bimodal-stereo", _pair=pair, _options=plain, paused=paused, charts=charts)

    @property
    def report(self) -> Optional[StepReport]:
        """The last report that the browser has sent; ``None`` before the first."""
        return StepReport._of(numbered(self._report)) if self._report else None
