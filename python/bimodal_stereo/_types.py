"""Input and output as plain objects."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence, TypeVar, Union

import numpy as np

from ._native import spelled

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ._sources import FilePath, Picture

    Floats = NDArray[np.float64]
    Singles = NDArray[np.float32]
    # Numbers, a file that holds them, or a picture of another package.
    Pixels = Union[ArrayLike, FilePath, Picture]
    CameraInput = Union["Pinhole", ArrayLike, Mapping[str, Any]]
    PoseInput = Union["Pose", ArrayLike, Mapping[str, Any]]


Made = TypeVar("Made")


def renamed(raw: Mapping[str, Any]) -> dict[str, Any]:
    """Members of the JavaScript contract by their Python names."""
    return {spelled(name): value for name, value in raw.items()}


def made(kind: type[Made], raw: Mapping[str, Any], **parts: Any) -> Made:
    """Makes an object from its members in the contract. Absent members are ``None``; ``parts`` replace members of the same name."""
    members = {**dict.fromkeys(kind.__annotations__), **renamed(raw), **parts}
    return kind(**members)


@dataclass(frozen=True)
class Pinhole:
    """A pinhole camera behind a lens, in pixels; pixel centres are whole numbers.

    ``distortion`` follows OpenCV: for the model "brown" 4, 5 or 8 numbers, k1 k2 p1 p2 [k3 [k4 k5 k6]]; for the model "fisheye"
    (Kannala-Brandt) the 4 numbers k1 k2 k3 k4. The default is no distortion; for a fisheye, zeros.
    """

    fx: float
    fy: float
    cx: float
    cy: float
    distortion: Sequence[float] = ()
    model: str = "brown"

    @property
    def K(self) -> Floats:
        """The matrix of the camera, (3, 3): fx 0 cx, 0 fy cy, 0 0 1."""
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])


@dataclass(frozen=True, eq=False)
class ColorImage:
    """One colour image of the object, up to 4096 pixels on a side.

    ``data``: (h, w, 3) or (h, w, 4), R G B and perhaps A, (h, w) grey, an image of Pillow or Open3D, or the path of a PNG,
        JPEG or .npy file. Floats are linear intensities above 0. Black, saturated and transparent pixels are left out.
    ``mask``: (h, w), non-zero where the object is, or a picture or a file of a mask; without it, all pixels.
    ``camera``: a ``Pinhole``, its matrix (3, 3), a dictionary with ``K``, ``distortion`` and ``model``, or Open3D's
        PinholeCameraIntrinsic, in pixels; without it the view is orthographic.
    ``transfer``: the encoding of uint8 and uint16, "srgb" or "linear". 8 bits default to "srgb"; for 16 bits it is guessed
        unless the file states it.
    """

    data: Pixels
    mask: Optional[Pixels] = None
    camera: Optional[CameraInput] = None
    transfer: Optional[str] = None


@dataclass(frozen=True, eq=False)
class DepthMap:
    """One depth map of the same object from another view. It has either ``data`` or ``points``.

    ``data``: (h, w), depth along z, an image of Pillow or Open3D, or the path of a PNG or .npy file. Zero, negative, NaN,
        and 1e12 or more are holes.
    ``points``: (h, w, 3), an organised cloud in the depth camera's frame, NaN where missing.
    ``mask``, ``camera``: those of ``ColorImage``.
    ``unit``: metres (or pixels, orthographic) per stored unit; default 1, and 0.001 for integers with a camera. For a file
        with a camera it is guessed, with a ``BimodalWarning``.
    ``normals``: (h, w, 3), unit normals that replace those computed from the depth.
    ``intensity``: (h, w), only for the check of a calibration: the strength of the return at each pixel, or any other
        quantity that depends on the surface's reflectivity, increasing or decreasing; NaN where unknown. Only its rank is
        used.
    """

    data: Optional[Pixels] = None
    points: Optional[ArrayLike] = None
    mask: Optional[Pixels] = None
    camera: Optional[CameraInput] = None
    unit: Optional[float] = None
    normals: Optional[ArrayLike] = None
    intensity: Optional[ArrayLike] = None


@dataclass(frozen=True)
class Angles:
    """Degrees of R = Rx(alpha) Ry(beta) Rz(gamma). A reported beta lies within -90 .. 90."""

    alpha: float = 0.0
    beta: float = 0.0
    gamma: float = 0.0


@dataclass(frozen=True, eq=False)
class Pose:
    """P_colour = scale * rotation @ P_depth + translation, in units of the colour view.

    ``rotation`` is (3, 3), ``translation`` (3,), ``matrix`` (4, 4), [scale * rotation, translation; 0 0 0 1]. As an initial pose any part
    may be left out, and ``angles`` may stand for the rotation.
    """

    scale: float
    rotation: Floats
    translation: Floats
    angles: Angles
    matrix: Optional[Floats] = None

    @classmethod
    def _of(cls, raw: Mapping[str, Any]) -> Pose:
        return made(
            cls,
            raw,
            rotation=np.reshape(raw["rotation"], (3, 3)),
            translation=np.array(raw["translation"]),
            angles=Angles(**raw["angles"]),
            matrix=np.array(raw["matrix"]),
        )


@dataclass(frozen=True)
class Energy:
    """The terms of the objective, each a robust mean, and their sum."""

    shading: float
    prior: float
    registration: float
    refinement: float
    total: float


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """One sigma of the pose, about and along the axes of the colour view.

    The true rotation is a small rotation times the estimated one.

    ``rotation_degrees``: (3,), about x, y, z, degrees.
    ``translation``: (3,), along x, y, z in the view's units, NaN where the views do not determine it.
    ``scale``: sigma of the scale, ``None`` if the scale is fixed.
    ``weakest``: the least certain direction in words.
    """

    rotation_degrees: Floats
    translation: Floats
    scale: Optional[float]
    weakest: str

    @classmethod
    def _of(cls, raw: Mapping[str, Any]) -> Uncertainty:
        # The conversion to floats turns `None` into NaN.
        arrays = {name: np.array(raw[key], float) for name, key in (("rotation_degrees", "rotationDegrees"), ("translation", "translation"))}
        return made(cls, raw, **arrays)


@dataclass(frozen=True, eq=False)
class StepReport:
    """State of the loop after a step.

    ``stage``: the stage that ran last: "search", "light", "shading", "surface", "registration" or "refinement".
    ``status``: "running", "converged", "max-iterations", "ambiguous" or "lost".
    ``reason``: the reason as a ``code`` for programs and its numbers; ``message``: the same in words.
    ``rivals``: other poses that fit the image equally well.
    ``rotation_change``: change of the rotation, degrees.
    ``overlap``: share of valid depth pixels with a correspondence; ``inliers``: share of the visible points within three medians of the surface.
    ``residual``: robust mean of the log-colour residual.
    ``milliseconds``: wall time of each stage in the last step. With ``workers`` the stages overlap, and it has the time of
        the whole "iteration".
    """

    iteration: int
    stage: str
    pose: Pose
    rotation_change: float
    energy: Energy
    overlap: float
    inliers: float
    residual: float
    status: str
    message: Optional[str]
    reason: Optional[Mapping[str, Any]]
    rivals: Sequence[Pose]
    uncertainty: Optional[Uncertainty]
    milliseconds: Mapping[str, float]

    @classmethod
    def _of(cls, raw: Mapping[str, Any]) -> StepReport:
        sigma, reason = raw.get("uncertainty"), raw.get("reason")
        return made(
            cls,
            raw,
            pose=Pose._of(raw["pose"]),
            energy=Energy(**raw["energy"]),
            reason=None if reason is None else renamed(reason),
            rivals=[Pose._of(rival) for rival in raw.get("rivals", ())],
            uncertainty=None if sigma is None else Uncertainty._of(sigma),
        )
