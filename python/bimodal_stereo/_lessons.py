"""Single parts of the method, for inspection."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Mapping, Optional, Union

import numpy as np

from . import _inputs, _native
from ._errors import BimodalError
from ._sources import array, flat, plain
from ._types import Angles

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._types import Floats, Singles

# The largest logarithm of a colour or coordinate of a normal; the squares of larger numbers carry no information.
FARTHEST = 1e6
LARGEST_SIDE = 512
# Largest slope and stretch of a depth; beyond it no shape is visible.
STEEPEST = 1e3


@dataclass(frozen=True, eq=False)
class PixelLandscape:
    """The objective of one pixel over all normals that a camera can see (Eq. 6), float32.

    ``objective``: (side, side), seen from the camera: n_x grows with the column, n_y with the row, both from -1 to 1;
    NaN without a normal.
    ``minima``: (n, 5), the lowest first: unit normal, objective, share of all directions whose descent ends there.
    ``path``: (m, 3), the normals after each step of one descent.
    """

    objective: Singles
    minima: Singles
    path: Singles


def integrate_normals(normals: ArrayLike, *, robust: bool = True) -> Singles:
    """Depth, (h, w) float32, in pixels, of the surface with these normals, seen by an orthographic camera.

    Its mean is zero in each connected part; NaN marks pixels without a normal.

    normals: (h, w, 3), unit normals, NaN where missing.
    robust: whether slopes across a discontinuity are ignored; otherwise the depth is the least-squares solution.
    """
    made = _inputs.shaped(array(normals, "normals", "float32"), "normals", (None, None, 3))
    planes = _inputs.singles(np.moveaxis(made, 2, 0))
    return _native.integrate_normals({"normals": planes, "height": made.shape[0], "width": made.shape[1], "robust": robust})


def turn_light(light: Union[str, ArrayLike], angles: Union[None, Angles, Mapping[str, float]] = None) -> Floats:
    """The coefficients of a light, (3, 9), rotated by angles in degrees: light that illuminated a normal n illuminates R n.

    light: a name of ``sample_lights()``, or 27 coefficients, (3, 9) or flat.
    """
    return _native.turn_light({"light": light_of(light), "angles": plain(angles)})


def shade_normals(light: Union[str, ArrayLike], normals: ArrayLike) -> Singles:
    """log S of R, G, B (natural logarithms) of unit normals under a light, in the normals' shape: (.., 3), float32.

    light: a name of ``sample_lights()``, or 27 coefficients, (3, 9) or flat.
    """
    made = directions(normals)
    shaded: Singles = _native.shade_normals({"light": light_of(light), "normals": made})
    return shaded.reshape(made.shape)


def pixel_landscape(
    log: ArrayLike,
    light: Union[str, ArrayLike],
    *,
    prior: Optional[ArrayLike] = None,
    weight: float = 0.0,
    robust: bool = True,
    start: Optional[ArrayLike] = None,
    side: int = 96,
) -> PixelLandscape:
    """The objective of one pixel over all normals that a camera can see, its minima, and the steps of one descent.

    log: natural logarithms of its linear R, G, B.
    light: a name of ``sample_lights()``, or 27 coefficients with the exposure.
    prior: the unit normal of a depth map at this pixel.
    weight: weight of the prior, ``lambda_["prior"]`` of ``Options``.
    robust: whether a prior that is far off loses its weight, as in the loop. False gives Eq. 9 as printed in the paper.
    start: the unit normal at which the descent starts; default: towards the camera.
    side: rows and columns of ``objective``, 0 .. 512.
    """
    if not weight >= 0:
        raise BimodalError("range", f"weight: must be zero or above (got {weight})", "weight")
    if _inputs.whole(side, "side", 0) > LARGEST_SIDE:
        raise BimodalError("range", f"side: must be a whole number from 0 to {LARGEST_SIDE} (got {side})", "side")
    vectors = {name: None if value is None else three(value, name) for name, value in (("log", log), ("prior", prior), ("start", start))}
    given = {**vectors, "light": light_of(light), "weight": weight, "robust": robust, "side": side}
    return PixelLandscape(**_native.pixel_landscape(given))


@dataclass(frozen=True, eq=False)
class BasRelief:
    """A surface that looks the same from the front under its own lamp: ``normals`` in the shape of those given, the factor of each ``albedo``,
    both float32, and the ``lamp``, (3,): its direction times its strength."""

    normals: Singles
    albedo: Singles
    lamp: Floats


def shade_lamp(lamp: ArrayLike, normals: ArrayLike) -> Singles:
    """Intensity, float32, of a matte surface of albedo 1 for each unit normal (.., 3) under one distant lamp.

    lamp: (3,), the direction to it times its strength; toward the camera is -z. The intensity is zero where the surface faces away.
    """
    made = directions(normals)
    shaded: Singles = _native.shade_lamp({"lamp": three(lamp, "lamp", 3), "normals": made})
    return shaded.reshape(made.shape[:-1])


def bas_relief(normals: ArrayLike, lamp: ArrayLike, stretch: float, *, right: float = 0.0, down: float = 0.0) -> BasRelief:
    """The generalised bas-relief transformation (Belhumeur, Kriegman and Yuille 1999): depth z becomes stretch z + right x + down y.

    normals: (.., 3), unit normals. lamp: (3,), the direction to it times its strength. stretch: not zero.
    """
    given = {"stretch": stretch, "right": right, "down": down}
    for name, value in given.items():
        if not abs(value) <= STEEPEST or name == "stretch" and value == 0:
            raise BimodalError("range", f"{name}: must be a number from -1000 to 1000, and stretch not zero (got {value})", name)
    made = directions(normals)
    raw = _native.bas_relief({**given, "lamp": three(lamp, "lamp", 3), "normals": made})
    return BasRelief(raw["normals"].reshape(made.shape), raw["albedo"].reshape(made.shape[:-1]), raw["lamp"])


def second_order(intensity: ArrayLike) -> Singles:
    """The least-squares approximation, by harmonics of orders 0 to 2, of an intensity that depends on one component of the normal only.

    intensity: (n,). Values and result, float32, belong to the middles of equal intervals of that component from -1 to 1.
    """
    return _native.second_order({"intensity": _inputs.singles(array(intensity, "intensity", "float32").ravel())})


def characteristic_strips(
    intensity: ArrayLike, lamp: ArrayLike, centre: ArrayLike, *, dent: bool = False, count: int = 24
) -> list[Singles]:
    """Characteristic strips (Horn 1970) of a picture of albedo 1 under one lamp of strength 1, from a bright spot outward.

    intensity: (h, w), NaN outside the object. lamp: (3,), the direction to it. centre: column and row of the bright
    spot. dent: whether the surface at the spot is assumed to be a dent. count: strips, 0 .. 360. Each strip is (n, 3),
    float32: column, row and depth in pixels.
    """
    made = _inputs.shaped(array(intensity, "intensity", "float32"), "intensity", (None, None))
    given = {"lamp": three(lamp, "lamp", 3), "centre": three(centre, "centre", 2), "dent": dent, "count": _inputs.whole(count, "count", 0)}
    size = {"height": made.shape[0], "width": made.shape[1]}
    return _native.characteristic_strips({**given, **size, "intensity": _inputs.singles(made)})


def directions(normals: ArrayLike) -> Singles:
    made = array(normals, "normals", "float32")
    if made.ndim == 0 or made.shape[-1] != 3:
        raise BimodalError("size", f"normals: must have the shape (.., 3), not {made.shape}", "normals")
    return _inputs.singles(made)


def three(value: ArrayLike, field: str, count: Optional[int] = None) -> Any:
    made = flat(value, field)
    if count is not None and made.size != count:
        raise BimodalError("size", f"{field}: must have {count} numbers, not {made.size}", field)
    wrong = ~(np.abs(made) <= FARTHEST)
    if wrong.any():
        raise BimodalError("range", f"{field}: must be numbers from -1e6 to 1e6 (got {made[wrong][0]})", field, int(wrong.argmax()))
    return made


def light_of(light: Union[str, ArrayLike]) -> Any:
    return light if isinstance(light, str) else flat(light, "light")
