"""Converts files, and the pictures, cameras and poses of other packages, to arrays and dictionaries.

No other package is imported, because an object is recognised by the package of its type.
"""

from __future__ import annotations

import os
import warnings
from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any, Callable, Mapping, Optional, Protocol, Sequence, TypeVar, Union

import numpy as np

from . import _native
from ._errors import BimodalError, BimodalWarning

if TYPE_CHECKING:
    from numpy.typing import NDArray

Made = TypeVar("Made")
FilePath = Union[str, "os.PathLike[str]"]


class Picture(Protocol):
    """An object that numpy converts to an array, such as an image of Pillow."""

    @property
    def __array_interface__(self) -> Any: ...


def plain(value: Any) -> Any:
    """Objects as dictionaries, and numbers of numpy as numbers of Python."""
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: plain(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, Mapping):
        return {key: plain(member) for key, member in value.items()}
    return value


def array(value: Any, field: str, what: str) -> NDArray[Any]:
    """An array of numbers."""
    try:
        made = np.asarray(value)
    except (TypeError, ValueError) as error:
        raise BimodalError("type", f"{field}: must be an array of {what}", field) from error
    if made.dtype.kind not in "buif":
        raise BimodalError("type", f"{field}: must be an array of {what}, not of {made.dtype}", field)
    return made


def flat(value: Any, field: str) -> NDArray[np.float64]:
    """Numbers one after the other, row after row."""
    return array(value, field, "numbers").astype(np.float64).ravel()


def matrix(value: Any, side: int, field: str) -> NDArray[np.float64]:
    """A square matrix."""
    made = array(value, field, "numbers").astype(np.float64)
    if made.ndim == 0:
        raise BimodalError("type", f"{field}: must be a matrix ({side}, {side}) or a dictionary, not {type(value).__name__}", field)
    if made.shape != (side, side):
        raise BimodalError("size", f"{field}: must have the shape ({side}, {side}), not {made.shape}", field)
    return made


def pose(value: Any, field: str) -> Any:
    """The members of a pose that is given by members or by a 4x4 matrix."""
    if value is None or isinstance(value, str):
        return value
    if not isinstance(value, Mapping) and not is_dataclass(value):
        return {"matrix": matrix(value, 4, field)}
    made = plain(value)
    for name in ("rotation", "translation", "matrix"):
        if made.get(name) is not None:
            made[name] = flat(made[name], f"{field}.{name}")
    return made


def camera(value: Any, field: str) -> Any:
    """The members of a camera that is given by members, by its matrix K, by ``{"K": .., "distortion": ..}``, or as an
    object of Open3D."""
    if value is None or is_dataclass(value):
        return plain(value)
    if package(value) == "open3d":
        value = value.intrinsic_matrix
    if not isinstance(value, Mapping):
        return of_matrix(value, field)
    if value.get("K") is None:
        return plain(value)
    twice = next((name for name in ("fx", "fy", "cx", "cy") if value.get(name) is not None), None)
    if twice is not None:
        raise BimodalError("option", f"{field}.{twice}: K already contains it; leave one of them out", f"{field}.{twice}")
    others = {name: member for name, member in value.items() if name != "K"}
    return {**plain(others), **of_matrix(value["K"], f"{field}.K")}


def of_matrix(value: Any, field: str) -> dict[str, float]:
    # Largest deviation of a factor of zero or one in a matrix that was stored in single precision.
    rounding = 1e-6
    k = matrix(value, 3, field)
    (fx, skew, cx), (below, fy, cy), last = k.tolist()
    if fx != 0 and abs(skew) > rounding * abs(fx):
        raise BimodalError("range", f"{field}: a camera with skew is not supported (got {skew} in row 1, column 2)", field)
    if below != 0 or last[:2] != [0, 0] or not abs(last[2] - 1) <= rounding:
        raise BimodalError("range", f"{field}: must be fx 0 cx, 0 fy cy, 0 0 1", field)
    return {"fx": fx, "fy": fy, "cx": cx, "cy": cy}


def package(value: Any) -> str:
    """The name of the package that defines a value's type."""
    return type(value).__module__.partition(".")[0]


def is_path(value: Any) -> bool:
    return isinstance(value, (str, os.PathLike))


def warn(found: Sequence[Mapping[str, Any]]) -> None:
    """Passes on the warnings of a reader."""
    for each in found:
        warnings.warn(BimodalWarning(each["code"], each["message"], each["field"]), stacklevel=4)


def picture(value: Any) -> Any:
    """An image of Pillow with its palette and its colour model resolved; anything else unchanged."""
    if package(value) != "PIL" or not hasattr(value, "convert"):
        return value
    kept = ("L", "RGB", "RGBA", "I", "F")
    if value.mode in kept or value.mode.startswith("I;16"):
        return value
    has_alpha = "A" in value.getbands() or "transparency" in value.info
    return value.convert("RGBA" if has_alpha else "RGB")


def read(reader: Callable[..., Made], path: Any, field: Optional[str], *others: Any) -> Made:
    """The result of a reader. An error names the argument for which the file was given, if there is one."""
    try:
        return reader(os.fspath(path), *others)
    except BimodalError as error:
        if field is None:
            raise
        raise BimodalError(error.code, f"{field}: {error}", field) from error


def colours(value: Any, transfer: Optional[str], field: Optional[str] = None) -> tuple[Any, Optional[str]]:
    """The pixels of a file or a picture, and their encoding of intensity if it is known."""
    if not is_path(value):
        return picture(value), transfer
    found = read(_native.read_image, value, field)
    warn(found["warnings"])
    return found["data"], transfer or found["transfer"]


def depth(path: Any, unit: Optional[float], is_metric: bool, field: Optional[str] = None) -> dict[str, Any]:
    """``data`` or ``points`` of a file, and ``unit``."""
    found = read(_native.read_depth, path, field, unit, is_metric)
    warn(found.pop("warnings"))
    return found


def points(value: Any) -> Any:
    """The points of a cloud of Open3D, which has no rows and columns; anything else unchanged."""
    return value.points if package(value) == "open3d" and hasattr(value, "points") else value


def mask(value: Any, field: str) -> Any:
    """A mask from a file, a picture or an array: non-zero where the object is."""
    if is_path(value):
        return read(_native.read_mask, value, field)
    made = picture(value)
    if made is value and package(value) != "PIL":
        return value
    pixels = np.asarray(made)
    if pixels.ndim == 2:
        return pixels
    inside = (pixels[..., :3] > 0).any(axis=2)
    return inside & (pixels[..., 3] > 127) if pixels.shape[2] == 4 else inside
