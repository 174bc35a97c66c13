"""Converts the caller's arrays and objects to contiguous arrays and dictionaries for the bindings."""

from __future__ import annotations

from dataclasses import replace
from operator import index
from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence, TypedDict, Union

import numpy as np

from . import _sources
from ._errors import BimodalError
from ._sources import array, camera, flat, plain, pose
from ._types import ColorImage, DepthMap

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ._types import Pixels, PoseInput

# Largest level of 16 bits, in which integers are stored.
LARGEST_LEVEL = 65535


class LightGaussian(TypedDict):
    """A Gaussian over lights: 27 coefficients, nine of red, of green, of blue, as ``light`` has them.

    mean: 27 numbers, (3, 9) or flat. covariance: (27, 27), symmetric and positive definite.
    """

    mean: ArrayLike
    covariance: ArrayLike


class StartTolerance(TypedDict, total=False):
    """How far from a given initial pose the result may lie.

    degrees: tolerance of the rotation; default 30.
    distance: tolerance of the object's centre, in units of the colour view; default: the width of the object.
    """

    degrees: float
    distance: float


class Weights(TypedDict, total=False):
    """Weights of the terms of the objective, 0 .. 1e6.

    prior: shape prior; default 0.05.
    unit: unit length of the normals; default 1.
    light: prior over natural lights; default 1e-6.
    refinement: shape prior of the depth view; default 0.01.
    """

    prior: float
    unit: float
    light: float
    refinement: float


class Options(TypedDict, total=False):
    """The options of a run; each has a default.

    light: "estimate" (the default), or 27 coefficients, (3, 9) or flat.
    prior: the prior over lights if the light is estimated; default: natural lights.
    start: "search" (the default), "identity", or an initial pose: a 4x4 matrix that transforms depth points into the
        colour view, or the known parts of the pose.
    start_tolerance: how far from a given initial pose the result may lie.
    registration: "joint" (the default), "icp" or "fixed".
    shading: "surface" (the default) or "pixel".
    scale: "free" (the default), or a fixed number.
    trim: whether flying pixels and background inside the mask are left out; default True.
    annealing: whether the robust scale of the registration starts wide and narrows; default True.
    lambda\\_: the weights of the terms.
    stop_degrees: the loop converges once the rotation changes by less than this; default 0.01.
    tolerance: largest sigma of the rotation of a run that converges, degrees; default 1.5.
    max_iterations: 1 .. 100000; default 60.
    correspondence_distance: largest distance of a correspondence, image pixels; by default it follows from the data.
    seed: seed of the random generator; default 1.
    workers: number of threads that share the work, 1 .. 16; the result is the same to the bit; default 1.
    """

    light: Union[str, ArrayLike]
    prior: LightGaussian
    start: Union[str, PoseInput]
    start_tolerance: StartTolerance
    registration: str
    shading: str
    scale: Union[str, float]
    trim: bool
    annealing: bool
    lambda_: Weights
    stop_degrees: float
    tolerance: float
    max_iterations: int
    correspondence_distance: float
    seed: int
    workers: int


def keywords(given: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments with objects as dictionaries and lights as numbers."""
    made: dict[str, Any] = plain({name: value for name, value in given.items() if name != "start"})
    if "start" in given:
        made["start"] = pose(given["start"], "start")
    light = made.get("light")
    if light is not None and not isinstance(light, str):
        made["light"] = flat(light, "light")
    prior = made.get("prior")
    if isinstance(prior, dict):
        made["prior"] = {name: None if value is None else flat(value, f"prior.{name}") for name, value in prior.items()}
    return made


def whole(value: Any, field: str, least: int) -> int:
    """A whole number of Python or numpy."""
    try:
        made = index(value)
    except TypeError as error:
        raise BimodalError("type", f"{field}: must be a whole number", field) from error
    if made < least:
        raise BimodalError("range", f"{field}: must be {least} or above, not {made}", field)
    return made


def shaped(made: NDArray[Any], field: str, *shapes: Sequence[Optional[int]]) -> NDArray[Any]:
    """The array, if it has one of the shapes; ``None`` is any length."""
    for shape in shapes:
        if made.ndim == len(shape) and all(want in (None, has) for want, has in zip(shape, made.shape)):
            return made
    spelled = " or ".join("(" + ", ".join(name(side, axis) for axis, side in enumerate(shape)) + ")" for shape in shapes)
    raise BimodalError("size", f"{field}: must have the shape {spelled}, not {made.shape}", field)


def name(side: Optional[int], axis: int) -> str:
    return "hw"[axis] if side is None else str(side)


def packed(made: NDArray[Any], kind: Any) -> NDArray[Any]:
    """The numbers as the bindings read them: row by row, aligned, in this machine's order of bytes."""
    return np.require(made, kind, ["C_CONTIGUOUS", "ALIGNED"])


def singles(made: NDArray[Any]) -> NDArray[np.float32]:
    # Numbers beyond 32 bits become infinite, which marks a hole or a pixel without colour.
    with np.errstate(over="ignore"):
        return packed(made, np.float32)


def mask(value: Any, field: str, shape: tuple[int, ...]) -> Optional[NDArray[np.uint8]]:
    if value is None:
        return None
    return packed(shaped(array(_sources.mask(value, field), field, "flags"), field, shape[:2]) != 0, np.uint8)


def image(given: Union[ColorImage, Pixels], path: str = "image") -> dict[str, Any]:
    """A colour image, or the pixels of one, for the bindings."""
    own = given if isinstance(given, ColorImage) else ColorImage(given)
    field = f"{path}.data"
    pixels, transfer = _sources.colours(own.data, own.transfer, field)
    data = shaped(array(pixels, field, "uint8, uint16 or float32"), field, (None, None, 3), (None, None, 4), (None, None))
    if data.ndim == 2:
        data = np.repeat(data[..., np.newaxis], 3, axis=2)
    if own.transfer == "srgb" and data.dtype.kind == "f":
        raise BimodalError("option", f"{path}.transfer: floats are linear; give integers, or decode them first", f"{path}.transfer")
    return {
        **size(data),
        "data": colours(data, field),
        "mask": mask(own.mask, f"{path}.mask", data.shape),
        "camera": camera(own.camera, f"{path}.camera"),
        "transfer": transfer,
    }


def size(data: NDArray[Any]) -> dict[str, int]:
    return {"width": data.shape[1], "height": data.shape[0]}


def colours(data: NDArray[Any], field: str) -> NDArray[Any]:
    """The colours as RGBA if they are integers, or as RGB if they are floats. Floats of transparent pixels become zero,
    which marks a pixel without colour."""
    if data.dtype.kind == "f":
        rgb = singles(data[..., :3])
        return rgb if data.shape[2] == 3 else singles(np.where(data[..., 3:] > 0, rgb, 0))
    if data.dtype.kind != "u" or data.dtype.itemsize > 2:
        raise BimodalError("type", f"{field}: must be uint8, uint16 or float32, not {data.dtype}", field)
    kind = np.uint8 if data.dtype.itemsize == 1 else np.uint16
    opaque = np.full((*data.shape[:2], 1), np.iinfo(kind).max, kind)
    return packed(data if data.shape[2] == 4 else np.concatenate([data, opaque], axis=2), kind)


def depth(given: Union[DepthMap, Pixels], path: str = "depth") -> dict[str, Any]:
    """A depth map, or the pixels of one or of an organised cloud, for the bindings."""
    own = given if isinstance(given, DepthMap) else of_pixels(given, path)
    if (own.data is None) == (own.points is None):
        said = "or depth.points is required" if own.data is None else "excludes depth.points: give one of the two"
        raise BimodalError("missing", f"{path}.data: {said}", f"{path}.data")
    if _sources.is_path(own.data):
        own = replace(own, **{"data": None, **_sources.depth(own.data, own.unit, own.camera is not None, f"{path}.data")})
    if own.data is not None:
        data = shaped(array(own.data, f"{path}.data", "float32 or uint16"), f"{path}.data", (None, None))
        rasters = {**size(data), "data": depths(data, f"{path}.data")}
    else:
        data = cloud(own.points, f"{path}.points", (None, None, 3))
        rasters = {**size(data), "points": data}
    normals = None if own.normals is None else cloud(own.normals, f"{path}.normals", (*data.shape[:2], 3))
    intensity = None if own.intensity is None else map_of(own.intensity, f"{path}.intensity", data.shape[:2])
    inside, own_camera = mask(own.mask, f"{path}.mask", data.shape), camera(own.camera, f"{path}.camera")
    return {**rasters, "mask": inside, "camera": own_camera, "unit": own.unit, "normals": normals, "intensity": intensity}


def of_pixels(given: Pixels, path: str) -> DepthMap:
    if _sources.is_path(given):
        return DepthMap(data=given)
    made = shaped(array(given, path, "depths or points"), path, (None, None), (None, None, 3))
    return DepthMap(data=made) if made.ndim == 2 else DepthMap(points=made)


def cloud(value: Any, field: str, shape: Sequence[Optional[int]]) -> NDArray[np.float32]:
    return singles(shaped(array(_sources.points(value), field, "float32"), field, shape))


def map_of(value: Any, field: str, shape: Sequence[Optional[int]]) -> NDArray[np.float32]:
    return singles(shaped(array(value, field, "float32"), field, shape))


def depths(data: NDArray[Any], field: str) -> NDArray[Any]:
    """Converts floats to 32 bits and integers to 16 bits, because some readers return the levels of a 16-bit file in 32
    bits."""
    if data.dtype.kind == "f":
        return singles(data)
    if data.dtype.kind == "b":
        raise BimodalError("type", f"{field}: must be float32 or uint16, not bool", field)
    if data.size > 0 and not (0 <= data.min() and data.max() <= LARGEST_LEVEL):
        raise BimodalError("range", f"{field}: integers must lie within 0 .. {LARGEST_LEVEL}; give others as floats", field)
    return packed(data, np.uint16)
