"""Whether the calibration between a colour camera and a depth camera is right."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Callable, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np

from . import _inputs, _native, _sources
from ._errors import BimodalError
from ._types import ColorImage, DepthMap, Pinhole, Pose, made, renamed

if TYPE_CHECKING:
    from ._types import Floats, Pixels, PoseInput, Singles


@dataclass(frozen=True, eq=False)
class CheckFrame:
    """One pair from a rig whose calibration is to be checked. It holds the whole frames; masks are optional.

    If the image has no camera, the focal length is estimated. ``depth`` is a depth map with its camera, or an
    organised cloud in metres. ``name`` is the frame's name in the report.
    """

    image: Union[ColorImage, Pixels]
    depth: Union[DepthMap, Pixels]
    name: Optional[str] = None


@dataclass(frozen=True, eq=False)
class RigSample(CheckFrame):
    """A frame of a rendered rig with the true extrinsics."""

    pose: Optional[Pose] = None


@dataclass(frozen=True)
class CandidateReport:
    """The result for one candidate: its verdict, "consistent", "off" or "undecided", and the reason with its numbers.

    ``code``: the reason, for programs.
    ``reading``: the convention in which the candidate was misread, such as "inverse"; ``None`` if it was not misread.
    ``off_degrees``, ``off_millimetres``: rotation from the estimate, and shift at the centre of the scene.
    ``off_axes``: the same by axis, from the estimate to the candidate: degrees about x, y, z, then millimetres along them.
    ``pixels``, ``interval``: expected reprojection error at the scene's depth, pixels of the colour image, and its 95 %
        interval.
    ``probability``: probability that a right candidate is at least this far from the estimate.
    """

    verdict: str
    code: str
    reason: str
    reading: Optional[str]
    off_degrees: float
    off_millimetres: float
    off_axes: tuple[float, ...]
    pixels: float
    interval: tuple[float, float]
    probability: float


class CueReport(NamedTuple):
    """A cue's share of the evidence, 0 .. 1, and its sharpness: the inverse of its sigma in pixels of the colour image."""

    share: float
    sharpness: float


class FrameReport(NamedTuple):
    """A frame's share of the evidence, 0 .. 1, and a note about its fault."""

    name: str
    share: float
    note: Optional[str]


class Sensitivity(NamedTuple):
    """Decrease of the log likelihood of a cue away from the estimate: offsets in degrees (rx ry rz) or millimetres (tx ty tz)."""

    cue: str
    axis: str
    offsets: Floats
    values: Floats


class NextFrame(NamedTuple):
    """The frame that would best determine the least certain unknown.

    ``axis``: this unknown, "rx", "ry", "rz" about the scene's centre or "tx", "ty", "tz", in the colour frame.
    ``sigma``: its present sigma, degrees or millimetres; ``expected``: the sigma with this frame added.
    ``motion``: the place of the scene of ``frame`` in the next frame: "nearer", "left", "right", "up", "down" or "turned".
    ``pose``: the same as a motion of its points, colour frame, metres. ``message``: the proposal in words.
    """

    axis: str
    sigma: float
    frame: str
    motion: str
    pose: Pose
    expected: float
    message: str


@dataclass(frozen=True, eq=False)
class CheckReport:
    """The result of a check. ``verdict`` and ``reason`` are those of the first candidate, which is the one being checked.

    ``code``: the reason, for programs.
    ``reading``: the convention in which the first candidate was misread, or ``None``.
    ``warnings``: guesses and suspicious inputs, each with ``code``, ``message``, ``field`` and its numbers.
    ``estimate``: the extrinsics that fit best, P_colour = rotation @ P_depth + translation, metres.
    ``overlap``: share of the depth points that the estimate puts onto the image, 0 .. 1.
    ``middle``: (3,), the centre of the scene in the colour frame, metres.
    ``covariance``: (6, 6), of a rotation vector in rad about the middle, then of a translation in m.
    ``focal``: ratio of the estimated focal length to the assumed one, and the sigma of its logarithm, if no colour
    camera was given.
    ``pixels``, ``interval``: expected reprojection error of the estimate, and its 95 % interval.
    ``tolerance``: largest expected error that passes, pixels of the colour image.
    ``next``: the frame to take next, or ``None`` without depth edges or if the colour camera is a guess.
    """

    verdict: str
    code: str
    reason: str
    reading: Optional[str]
    warnings: Sequence[Mapping[str, Any]]
    estimate: Pose
    overlap: float
    middle: Floats
    covariance: Floats
    focal: Optional[tuple[float, float]]
    pixels: float
    interval: tuple[float, float]
    tolerance: float
    candidates: Mapping[str, CandidateReport]
    cues: Mapping[str, CueReport]
    frames: Sequence[FrameReport]
    sensitivity: Sequence[Sensitivity]
    next: Optional[NextFrame]


def check_calibration(
    frames: Sequence[CheckFrame],
    candidates: Mapping[str, PoseInput],
    *,
    cues: Optional[Sequence[str]] = None,
    on_progress: Optional[Callable[[float, str], Any]] = None,
) -> CheckReport:
    """Checks whether frames agree with candidates for the extrinsics of a rig.

    The extrinsics are P_colour = rotation @ P_depth + translation in metres.

    candidates: poses by name, each a 4x4 matrix, or ``rotation`` (3, 3) and ``translation`` (3,); the first one is checked.
    cues: a selection of "shading", "edges", "information" and "silhouette"; default: all.
    on_progress: called with the share of the work done, 0 .. 1, and a description of the current step.
    """
    if not isinstance(candidates, Mapping):
        raise BimodalError("type", "candidates: must be a dictionary of poses by name", "candidates")
    if cues is not None and (isinstance(cues, str) or not all(isinstance(cue, str) for cue in cues)):
        raise BimodalError("type", "cues: must be a list of words", "cues")
    if cues is not None and len(cues) == 0:
        raise BimodalError("size", "cues: needs at least one cue", "cues")
    if isinstance(frames, CheckFrame):
        raise BimodalError("type", "frames: must be a list of frames", "frames")
    named = [(str(name), _sources.pose(pose, f"candidates.{name}")) for name, pose in candidates.items()]
    given = [rig_frame(frame, index) for index, frame in enumerate(frames)]
    raw = _native.check_calibration(given, named, list(cues or []), on_progress)
    health = raw.pop("health")
    return made(
        CheckReport,
        raw,
        warnings=[renamed(warning) for warning in raw["warnings"]],
        estimate=Pose._of(raw["estimate"]),
        middle=np.array(raw["middle"]),
        covariance=np.reshape(raw["covariance"], (6, 6)),
        focal=tuple(raw["focal"]) if "focal" in raw else None,
        pixels=health["pixels"],
        interval=tuple(health["interval"]),
        candidates={name: made(CandidateReport, one, interval=tuple(one["interval"]), off_axes=tuple(one["offAxes"])) for name, one in raw["candidates"].items()},
        cues={name: CueReport(**one) for name, one in raw["cues"].items()},
        frames=[made(FrameReport, one) for one in raw["frames"]],
        sensitivity=[
            made(Sensitivity, one, offsets=np.array(one["offsets"]), values=np.array(one["values"])) for one in raw["sensitivity"]
        ],
        next=made(NextFrame, raw["next"], pose=Pose._of(raw["next"]["pose"])) if "next" in raw else None,
    )


@dataclass(frozen=True, eq=False)
class FrameOverlay:
    """The projection of a frame into its image, float32.

    ``points``: (n, 3), column, row in pixels and depth in metres of each visible depth point. ``positions``: (n, 3), the same points in the
    colour camera's frame, metres. ``edges``: (m, 2), column and row of each point of a depth edge.
    """

    points: Singles
    positions: Singles
    edges: Singles


def project_frame(frame: CheckFrame, pose: PoseInput) -> FrameOverlay:
    """Projects the depth points and depth edges of a frame into its image under a pose.

    pose: extrinsics, P_colour = rotation @ P_depth + translation in metres: a 4x4 matrix, or ``rotation`` and ``translation``.
    """
    return FrameOverlay(**_native.project_frame(rig_frame(frame, 0), _sources.pose(pose, "pose")))


def rig_frame(frame: CheckFrame, index: int) -> dict[str, Any]:
    path = f"frames[{index}]"
    if not isinstance(frame, CheckFrame):
        raise BimodalError("type", f"{path}: must be a CheckFrame, not {type(frame).__name__}", path)
    image = _inputs.image(frame.image, f"{path}.image")
    return {"image": image, "depth": _inputs.depth(frame.depth, f"{path}.depth"), "name": frame.name}


def sample_rig(
    kind: str,
    *,
    seed: Optional[int] = None,
    frame: Optional[int] = None,
    noise: Optional[float] = None,
    motion: Optional[PoseInput] = None,
) -> RigSample:
    """One frame of a rendered rig whose extrinsics are known.

    kind: "objects", "sheet", "boxes" or "room".
    seed: seed of the rig; default 0.
    frame: number of the frame; frames of one seed share the rig and show different scenes; default 0.
    noise: factor on the noise of both sensors; default 1.
    motion: a 4x4 matrix, or ``rotation`` and ``translation``, that moves each point of the scene in the colour camera's frame, metres;
        default: none.
    """
    moved = None if motion is None else _sources.pose(motion, "motion")
    raw = _native.sample_rig({"kind": kind, "seed": seed, "frame": frame, "noise": noise, "motion": moved})
    image, depth = ({**raw[view], "camera": Pinhole(**raw[view]["camera"])} for view in ("image", "depth"))
    return RigSample(ColorImage(**image), DepthMap(**depth), raw["name"], Pose._of(raw["pose"]))
