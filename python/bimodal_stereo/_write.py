"""Writes the results of a run to files that other programs read."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from . import _inputs, _native
from ._errors import BimodalError
from ._sources import array, points as points_of, pose as members_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._estimator import Estimator
    from ._sources import FilePath
    from ._types import PoseInput

LARGEST = 65_535
POINT = [("x", "<f4"), ("y", "<f4"), ("z", "<f4")]
COLOUR = [("red", "u1"), ("green", "u1"), ("blue", "u1")]
PLY = {"<f4": "float", "u1": "uchar"}


def write_results(estimator: Estimator, folder: FilePath) -> list[str]:
    """Writes the results of an estimator into a folder, as the command line does. Returns the files' paths and descriptions of their contents.

    clouds.ply: both surfaces in the colour view's frame. refined-depth.png (16 bits) and refined-depth.npy: depth of the depth view.
    pose.json and depth_to_colour.txt: the pose and its 4x4 matrix. light.csv: the coefficients.
    """
    written: list[str] = estimator._own.write_results(os.fspath(folder))
    return written


def write_pose(path: FilePath, pose: PoseInput) -> None:
    """Writes the 4x4 matrix of a pose with its scale as four lines of text; ``numpy.loadtxt`` and ``read_calibration`` read it."""
    _put(path, _native.matrix_text(members_of(pose, "pose")).encode())


def write_depth(path: FilePath, depth: ArrayLike, unit: str = "m") -> str:
    """Writes depths, (h, w), as a 16-bit PNG, 0 where missing. Returns the step of the stored numbers in words, such as "0.1 mm".

    unit: of the depths, "m" or "px". The step is the finest that reaches the farthest depth; the file's text chunk "Unit" states it as well.
    """
    made = _inputs.singles(_inputs.shaped(array(depth, "depth", "depths"), "depth", (None, None)))
    if unit not in ("m", "px"):
        raise BimodalError("option", 'unit: must be "m" or "px"', "unit")
    # Larger numbers are holes in 32-bit floats.
    lost = (np.rint(made) > LARGEST) & (made < np.float32(1e12))
    if unit == "px":
        # Depths in pixels may have any origin, but values below zero would be holes here.
        lost |= made < 0
    if lost.any():
        value = made[lost][0]
        said = f"depth: {value} {unit} cannot be stored, because only 0 to {LARGEST} {unit} fit; shift the depths, or write them with numpy.save"
        raise BimodalError("range", said, "depth", int(lost.argmax()), float(value))
    image, says = _native.depth_png({"depth": np.where(made < np.float32(1e12), made, 0), "width": made.shape[1]}, unit == "m")
    _put(path, image)
    return str(says)


def write_cloud(path: FilePath, points: Any, colours: Optional[ArrayLike] = None) -> None:
    """Writes points, (n, 3) or (h, w, 3) or a PointCloud of Open3D, as a binary PLY, without those that are not finite.

    colours: of each point, in the shape of ``points``: uint8, or floats from 0 to 1.
    """
    made = _inputs.singles(rows(points, "points"))
    kept = np.isfinite(made).all(axis=1)
    cloud = np.empty(int(kept.sum()), POINT if colours is None else POINT + COLOUR)
    inks = None if colours is None else rows(colours, "colours")
    if inks is not None and inks.shape != made.shape:
        raise BimodalError("size", f"colours: must have the shape of points, {made.shape}, not {inks.shape}", "colours")
    for axis, (name, _) in enumerate(POINT):
        cloud[name] = made[kept, axis]
    if inks is not None:
        levels = np.rint(255 * np.clip(inks, 0, 1)) if inks.dtype.kind == "f" else inks
        for axis, (name, _) in enumerate(COLOUR):
            cloud[name] = levels[kept, axis].astype(np.uint8)
    kinds = POINT if inks is None else POINT + COLOUR
    properties = "".join(f"property {PLY[kind]} {name}\n" for name, kind in kinds)
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(cloud)}\n{properties}end_header\n"
    _put(path, header.encode() + cloud.tobytes())


def rows(values: Any, field: str) -> Any:
    made = array(points_of(values), field, "numbers")
    if made.ndim < 2 or made.shape[-1] != 3:
        raise BimodalError("size", f"{field}: must have the shape (n, 3) or (h, w, 3), not {made.shape}", field)
    return made.reshape(-1, 3)


def _put(path: FilePath, content: bytes) -> None:
    with open(path, "wb") as file:
        file.write(content)
