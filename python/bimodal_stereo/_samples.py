"""Rendered scenes with a known answer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Mapping, Optional, TypedDict, Union

from . import _inputs, _native
from ._sources import array
from ._types import Angles, ColorImage, DepthMap, Pinhole, Pose

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
    from typing_extensions import Unpack

    from ._types import Floats, Singles


@dataclass(frozen=True, eq=False)
class Truth:
    """The true values of the results, NaN outside the masks: normals (h, w, 3) and depths (h, w) of both views,
    float32."""

    image_normals: Singles
    image_depth: Singles
    depth_normals: Singles
    depth: Singles


@dataclass(frozen=True, eq=False)
class Sample:
    """Two views of one surface, its ``light`` (3, 9) and the true ``pose``."""

    image: ColorImage
    depth: DepthMap
    light: Floats
    pose: Pose
    truth: Truth


def sample(
    surface: Union[str, ArrayLike],
    light: Union[str, ArrayLike],
    *,
    size: Optional[int] = None,
    height: Optional[int] = None,
    protocol: Optional[str] = None,
    angles: Union[None, Angles, Mapping[str, float]] = None,
    scale: Optional[float] = None,
    overlap: Optional[float] = None,
    noise: Optional[float] = None,
    depth_noise: Optional[float] = None,
    holes: Optional[float] = None,
    seed: Optional[int] = None,
) -> Sample:
    """Renders a colour image and a depth map of a surface.

    surface: a name of ``sample_surfaces()``, or heights (h, w), 64 .. 512 on a side: larger is nearer, zero or NaN is
        background.
    light: a name of ``sample_lights()``, or 27 coefficients.
    size: side of both views in pixels, 16 .. 1024; default 64.
    height: height of both views if it differs from ``size``.
    protocol: "rendered" (the default), or "grid", the paper's bare grid.
    angles: angles of the true pose, degrees; default: beta = 20.
    scale: scale of the true pose; default 1.
    overlap: share of the depth map's columns that is kept; default 1.
    noise: sigma of the noise on the logarithm of the colours; default 0.
    depth_noise: sigma of the noise on depth, pixels; default 0.
    holes: share of the depth pixels that is lost; default 0.
    seed: seed of noise and holes; default 1.
    """
    options = {
        "size": size,
        "height": height,
        "protocol": protocol,
        "angles": angles,
        "scale": scale,
        "overlap": overlap,
        "noise": noise,
        "depth_noise": depth_noise,
        "holes": holes,
        "seed": seed,
    }
    raw = _native.sample(requested(surface, light, options))
    return Sample(
        image=ColorImage(**with_pinhole(raw["image"])),
        depth=DepthMap(**with_pinhole(raw["depth"])),
        light=raw["light"],
        pose=Pose._of(raw["pose"]),
        truth=Truth(**raw["truth"]),
    )


class SampleOptions(TypedDict, total=False):
    """The options of ``sample``."""

    size: Optional[int]
    height: Optional[int]
    protocol: Optional[str]
    angles: Union[None, Angles, Mapping[str, float]]
    scale: Optional[float]
    overlap: Optional[float]
    noise: Optional[float]
    depth_noise: Optional[float]
    holes: Optional[float]
    seed: Optional[int]


def sample_bound(
    surface: Union[str, ArrayLike], light: Union[str, ArrayLike], *, light_is_known: bool, **options: Unpack[SampleOptions]
) -> Optional[float]:
    """The Cramer-Rao bound of the rotation in that scene, one sigma, degrees: no unbiased estimator has a smaller error.

    The arguments are those of ``sample``. ``None`` without noise and for scenes that do not determine the rotation.
    """
    return _native.sample_bound(requested(surface, light, options), light_is_known)


def requested(surface: Any, light: Any, options: Mapping[str, Any]) -> dict[str, Any]:
    if not isinstance(surface, str):
        surface = _inputs.singles(array(surface, "surface", "heights"))
    return _inputs.keywords({"surface": surface, "light": light, **options})


def with_pinhole(view: Mapping[str, Any]) -> Mapping[str, Any]:
    return {**view, "camera": Pinhole(**view["camera"])} if "camera" in view else view


def sample_surfaces() -> list[str]:
    """Names of the built-in surfaces."""
    return _native.sample_surfaces()


def sample_lights() -> list[str]:
    """Names of the built-in lights."""
    return _native.sample_lights()
