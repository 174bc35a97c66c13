"""Rendered pairs of views of one object, and suggested masks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Union

import numpy as np

from . import _inputs, _native
from ._errors import BimodalError
from ._samples import with_pinhole
from ._sources import array
from ._types import ColorImage, DepthMap, Pose

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ._types import Pixels


@dataclass(frozen=True, eq=False)
class PairSample:
    """A rendered pair: 8-bit colours, millimetres with the noise, steps, holes and shadows of a sensor, and the true ``pose``."""

    name: str
    image: ColorImage
    depth: DepthMap
    pose: Pose


@dataclass(frozen=True, eq=False)
class MaskSuggestion:
    """A suggested ``mask``, (h, w) of bool, the ``share`` of the image that is the object, the number of ``rounds``,
    and the share of the pixels that the last round ``changed``."""

    mask: NDArray[np.bool_]
    share: float
    rounds: int
    changed: float


def sample_pair(kind: str) -> PairSample:
    """A rendered pair of views of one object whose pose is known. kind: "bust", "knot", "marble", "relief", "cut" or "bowl"."""
    raw = _native.sample_pair({"kind": kind})
    views = (with_pinhole(raw[view]) for view in ("image", "depth"))
    image, depth = views
    return PairSample(raw["name"], ColorImage(**image), DepthMap(**depth), Pose._of(raw["pose"]))


def suggest_mask(image: Union[ColorImage, Pixels], marks: ArrayLike) -> MaskSuggestion:
    """The mask of the object in a colour image, from a rectangle around it or from strokes.

    image: a colour image of 8 bits.
    marks: (h, w), one number for each pixel: 0 certainly background, 1 certainly the object, 2 probably background, 3
        probably the object.

    The method is a random walker with colour models, in at most twelve rounds.
    """
    data = _inputs.image(image)["data"]
    if data.dtype != np.uint8:
        raise BimodalError("type", f"image.data: must be uint8, not {data.dtype}", "image.data")
    known = _inputs.shaped(array(marks, "marks", "uint8"), "marks", data.shape[:2])
    if known.size and (known.min() < 0 or known.max() > LARGEST_MARK):
        raise BimodalError("range", "marks: must be 0, 1, 2 or 3", "marks")
    size = {"height": data.shape[0], "width": data.shape[1]}
    return MaskSuggestion(**_native.suggest_mask({"data": data, "marks": _inputs.packed(known, np.uint8), **size}))


LARGEST_MARK = 3
