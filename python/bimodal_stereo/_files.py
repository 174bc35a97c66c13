"""Files of a rig: calibrations, and folders of frames."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence

from . import _native, _sources
from ._calibration import CheckFrame
from ._types import ColorImage, DepthMap, Pinhole, Pose

if TYPE_CHECKING:
    from ._sources import FilePath
    from ._types import CameraInput, Pixels


@dataclass(frozen=True)
class ReaderWarning:
    """Something that a reader guessed or that looks wrong: a stable code, a sentence, and the file."""

    code: str
    message: str
    field: Optional[str]


@dataclass(frozen=True)
class NamedCamera:
    """A camera of a file, with its name and the size (width, height) of its images if the file states them."""

    name: Optional[str]
    camera: Pinhole
    size: Optional[tuple[int, int]]


@dataclass(frozen=True, eq=False)
class NamedPose:
    """P_target = rotation @ P_source + translation, metres, with the names of the pose and of its frames if the file
    states them."""

    name: Optional[str]
    source: Optional[str]
    target: Optional[str]
    pose: Pose


@dataclass(frozen=True, eq=False)
class Calibration:
    """The cameras and poses of one file. ``says``: a description of what was read."""

    cameras: Sequence[NamedCamera]
    poses: Sequence[NamedPose]
    says: str
    warnings: Sequence[ReaderWarning]


@dataclass(frozen=True, eq=False)
class RigFolder:
    """The frames of a folder with their cameras, for ``check_calibration``, and the cameras and poses that lie beside them."""

    frames: Sequence[CheckFrame]
    cameras: Sequence[NamedCamera]
    poses: Sequence[NamedPose]
    warnings: Sequence[ReaderWarning]


def read_image(
    path: FilePath, *, mask: Optional[Pixels] = None, camera: Optional[CameraInput] = None, transfer: Optional[str] = None
) -> ColorImage:
    """Reads a PNG, JPEG or .npy file as a colour image: uint8 or uint16 (h, w, 4), or float32 (h, w, 3), which is linear.

    The image is upright, in sRGB where the file has a colour profile. ``transfer`` overrides what the file states. Grey is accepted.
    """
    data, known = _sources.colours(os.fspath(path), transfer)
    return ColorImage(data, mask, camera, known)


def read_depth(
    path: FilePath, *, mask: Optional[Pixels] = None, camera: Optional[CameraInput] = None, unit: Optional[float] = None
) -> DepthMap:
    """Reads a PNG or .npy file as a depth map, or a .npy file of three channels as an organised cloud.

    With a camera depths are metric, and ``unit`` is the number of metres per stored unit; if it is not given, it is
    guessed, with a ``BimodalWarning``. Without a camera depths are in pixels.
    """
    found = _sources.depth(path, unit, camera is not None)
    return DepthMap(mask=mask, camera=camera, **found)


def read_calibration(path: FilePath) -> Calibration:
    """Reads cameras and poses: matrices in text, JSON, YAML and XML of OpenCV, ROS, Kalibr and Open3D, texts of RealSense and COLMAP."""
    raw = _native.read_calibration(os.fspath(path))
    return Calibration(_cameras(raw), _poses(raw), raw["says"], _warnings(raw))


def read_rig_folder(
    path: FilePath, *, unit: Optional[float] = None, frames: Optional[int] = None, cameras: Sequence[FilePath] = ()
) -> RigFolder:
    """Reads a folder of frames: pairs of a colour image and a depth map with matching names, or as TUM RGB-D and Redwood
    store them.

    unit: metres per stored unit of all depth maps; without it, the unit is guessed, with a warning.
    frames: largest number of pairs, evenly spread over the folder; default 20.
    cameras: files of intrinsics outside the folder, which take precedence over those in it.
    """
    raw = _native.read_rig_folder(os.fspath(path), unit, frames, [os.fspath(each) for each in cameras])
    return RigFolder([_frame(each) for each in raw["frames"]], _cameras(raw), _poses(raw), _warnings(raw))


def _frame(raw: Mapping[str, Any]) -> CheckFrame:
    image, depth = (
        {**raw[view], "camera": None if raw[view]["camera"] is None else Pinhole(**raw[view]["camera"])}
        for view in ("image", "depth")
    )
    return CheckFrame(ColorImage(**image), DepthMap(**depth), raw["name"])


def _cameras(raw: Mapping[str, Any]) -> list[NamedCamera]:
    return [NamedCamera(each["name"], Pinhole(**each["camera"]), each["size"]) for each in raw["cameras"]]


def _poses(raw: Mapping[str, Any]) -> list[NamedPose]:
    return [NamedPose(**{**each, "pose": Pose._of(each["pose"])}) for each in raw["poses"]]


def _warnings(raw: Mapping[str, Any]) -> list[ReaderWarning]:
    return [ReaderWarning(**each) for each in raw["warnings"]]
