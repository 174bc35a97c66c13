"""The bindings in Pyodide: the npm package's WebAssembly, called through JavaScript.

A native extension for Pyodide needs Rust's target for Emscripten; this adapter needs none. It has the same functions as the native bindings
(``_native.pyi``). Files are read and written natively only, so those functions raise a ``BimodalError`` of code "unsupported". Without threads
of its own it ignores ``workers``.
"""

from __future__ import annotations

import json
from importlib.resources import files
from typing import Any, Callable, Mapping, NoReturn, Optional, Sequence

import numpy as np
from js import Object
from pyodide.code import run_js
from pyodide.ffi import JsException, create_proxy, to_js

from ._errors import BimodalError

FILES = files(__package__) / "_pyodide"
# The three modules: the method, the check and the rendered rigs.
MODULES = ("bimodal_stereo_bg.wasm", "bimodal_stereo_check_bg.wasm", "bimodal_stereo_rigs_bg.wasm")
CODES: str = (FILES / "codes.json").read_text("utf-8")
VERSION: str = (FILES / "version.txt").read_text("utf-8").strip()

_js: Any = run_js((FILES / "method.js").read_text("utf-8") + "; bimodalStereo")
_js.start(*(to_js((FILES / name).read_bytes()) for name in MODULES))


def spelled(name: str) -> str:
    """A name of the contract, or a path of names, in Python's spelling."""
    if name.startswith("candidates."):
        return name
    own = "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in name.removeprefix("options."))
    return ".".join("lambda_" if part == "lambda" else part for part in own.split("."))


# Members of a request in JavaScript are arguments here.
REQUESTS = ("sample.", "request.", "landscape.", "strips.")


def camel(name: str) -> str:
    first, *others = name.rstrip("_").split("_")
    return first + "".join(other.capitalize() for other in others)


def translated(error: Any) -> BaseException:
    """The package's own error, if it is one."""
    if getattr(error, "name", None) != "BimodalError":
        return error
    field = known(getattr(error, "field", None))
    message = str(error.message)
    if field is not None:
        own = spelled(next((field[len(request) :] for request in REQUESTS if field.startswith(request)), field))
        message, field = (own + message[len(field) :] if message.startswith(field) else message), own
    return BimodalError(error.code, message, field, known(getattr(error, "index", None)), known(getattr(error, "value", None)))


def known(value: Any) -> Any:
    """``None`` for the values that JavaScript uses for missing ones: undefined, and null, which newer versions of
    Pyodide pass as an object."""
    return None if type(value).__name__ == "JsNull" else value


def called(function: Any, *arguments: Any) -> Any:
    try:
        return function(*(plain(argument) for argument in arguments))
    except JsException as error:
        raise translated(error) from None


def members(given: Mapping[str, Any]) -> Any:
    """An object of JavaScript. Attributes of the proxy cannot have names such as ``new``."""
    return Object.fromEntries(to_js([to_js([name, value]) for name, value in given.items()]))


def plain(value: Any) -> Any:
    """A value for JavaScript: absent members are left out, and arrays are copied and flattened."""
    if isinstance(value, Mapping):
        return members({camel(name): plain(member) for name, member in value.items() if member is not None})
    if isinstance(value, np.ndarray):
        return to_js(memoryview(np.ravel(value)))
    if isinstance(value, (list, tuple)):
        return to_js([plain(each) for each in value])
    return value


def array(values: Any, kind: str, *shape: int) -> Any:
    """A typed array as an array of numpy's, which owns its memory."""
    return np.frombuffer(values.to_bytes(), kind).copy().reshape(shape)


def objects(value: Any) -> Any:
    """Plain objects, lists and numbers of JavaScript, whose null is ``None``."""
    return json.loads(_js.text(value))


def view(made: Any, kind: str, channels: Sequence[int], unit: Optional[float] = None) -> dict[str, Any]:
    shape = (made.height, made.width)
    own: dict[str, Any] = {}
    if getattr(made, "data", None) is not None:
        own["data"] = array(made.data, kind, *shape, *channels)
    for name in ("points", "normals"):
        if getattr(made, name, None) is not None:
            own[name] = array(getattr(made, name), "f4", *shape, 3)
    if getattr(made, "mask", None) is not None:
        own["mask"] = array(made.mask, "u1", *shape) != 0
    if getattr(made, "camera", None) is not None:
        own["camera"] = objects(made.camera)
    if unit is not None:
        own["unit"] = unit
    return own


class Estimator:
    def __init__(self, image: dict[str, Any], depth: dict[str, Any], keywords: dict[str, Any]) -> None:
        self._image, self._depth = ((own["height"], own["width"]) for own in (image, depth))
        options = {**keywords, "workers": None}
        self._own = called(_js.Estimator.new, image, depth, options)
        self._begun, self._slices = False, 0

    def __del__(self) -> None:
        if hasattr(self, "_own"):
            self._own.free()

    def _after(self, step: Any) -> dict[str, Any]:
        report: dict[str, Any] = objects(called(step))
        self._begun = True
        self._slices += report["stage"] == "search"
        return report

    def step(self) -> dict[str, Any]:
        return self._after(self._own.step)

    def step_stage(self) -> dict[str, Any]:
        return self._after(self._own.stepStage)

    def report(self) -> dict[str, Any]:
        made: dict[str, Any] = objects(self._own.report)
        return made

    def reset(self, keywords: Optional[dict[str, Any]]) -> None:
        called(self._own.reset, *(() if keywords is None else ({**keywords, "workers": None},)))
        self._begun, self._slices = False, 0

    def _raster(self, name: str, of: tuple[int, int], *channels: int, kind: str = "f4") -> Any:
        return array(called(getattr(self._own, name)), kind, *of, *channels)

    def image_normals(self) -> Any:
        return self._raster("imageNormals", self._image, 3)

    def image_depth(self) -> Any:
        return self._raster("imageDepth", self._image)

    def depth_normals(self) -> Any:
        return self._raster("depthNormals", self._depth, 3)

    def refined_depth(self) -> Any:
        return self._raster("refinedDepth", self._depth)

    def correspondence(self) -> Any:
        return self._raster("correspondence", self._image, kind="i4")

    def residual(self) -> Any:
        return self._raster("residual", self._image)

    def albedo(self) -> Any:
        return self._raster("albedo", self._image, 3)

    def shading(self) -> Any:
        return self._raster("shading", self._image, 3)

    def light(self) -> Any:
        return array(called(self._own.light), "f8", 3, 9)

    def points(self, of_depth: bool) -> Any:
        return array(called(self._own.points, "depth" if of_depth else "image"), "f4", -1, 3)

    def reached(self) -> tuple[dict[str, Any], bytes]:
        report = self.report()
        times = {**report, "milliseconds": None}
        found = json.dumps(times).encode() + self._own.light().to_bytes() + self._own.imageDepth().to_bytes() + self._own.refinedDepth().to_bytes()
        members = {name: report[name] for name in ("stage", "iteration")}
        return {"begun": self._begun, **members, "slices": self._slices, "ended": report["status"] != "running"}, found

    def write_results(self, folder: str) -> NoReturn:
        unsupported("write_results")


def scene(keywords: dict[str, Any]) -> dict[str, Any]:
    """A request of a scene. JavaScript takes the heights of a surface together with their size."""
    surface = keywords["surface"]
    if not isinstance(surface, np.ndarray):
        return keywords
    return {**keywords, "surface": {"width": surface.shape[1], "height": surface.shape[0], "heights": surface}}


def sample(keywords: dict[str, Any]) -> dict[str, Any]:
    made = called(_js.sample, scene(keywords))
    sides = {name: (own.height, own.width) for name, own in (("image", made.image), ("depth", made.depth))}
    truth = {
        "image_normals": array(made.truth.imageNormals, "f4", *sides["image"], 3),
        "image_depth": array(made.truth.imageDepth, "f4", *sides["image"]),
        "depth_normals": array(made.truth.depthNormals, "f4", *sides["depth"], 3),
        "depth": array(made.truth.depth, "f4", *sides["depth"]),
    }
    views = {"image": view(made.image, "f4", [3]), "depth": view(made.depth, "f4", [])}
    return {**views, "truth": truth, "light": array(made.light, "f8", 3, 9), "pose": objects(made.pose)}


def sample_bound(keywords: dict[str, Any], light_is_known: bool) -> Optional[float]:
    bound: Optional[float] = known(called(_js.sampleBound, scene(keywords), light_is_known))
    return bound


def sample_surfaces() -> list[str]:
    return list(_js.sampleSurfaces())


def sample_lights() -> list[str]:
    return list(_js.sampleLights())


def check_calibration(
    frames: list[dict[str, Any]],
    candidates: list[tuple[str, Any]],
    cues: list[str],
    on_progress: Optional[Callable[[float, str], Any]],
) -> dict[str, Any]:
    poses = members({name: plain(pose) for name, pose in candidates})
    tell = create_proxy(on_progress or (lambda share, message: None))
    try:
        given = to_js([plain(frame) for frame in frames])
        report: dict[str, Any] = objects(called(_js.checkCalibration, given, poses, cues or None, tell))
    finally:
        tell.destroy()
    return report


def project_frame(frame: dict[str, Any], pose: Any) -> dict[str, Any]:
    made = called(_js.projectFrame, frame, pose)
    return {name: array(getattr(made, name), "f4", -1, 2 if name == "edges" else 3) for name in ("points", "positions", "edges")}


def integrate_normals(keywords: dict[str, Any]) -> Any:
    height, width = keywords["height"], keywords["width"]
    # JavaScript takes the three numbers of each normal in turn.
    normals = np.ascontiguousarray(np.moveaxis(keywords["normals"].reshape(3, height, width), 0, 2))
    return array(called(_js.integrateNormals, normals, width, height, keywords["robust"]), "f4", height, width)


def turn_light(keywords: dict[str, Any]) -> Any:
    return array(called(_js.turnLight, keywords["light"], keywords["angles"] or {}), "f8", 3, 9)


def shade_normals(keywords: dict[str, Any]) -> Any:
    return array(called(_js.shadeNormals, keywords["light"], keywords["normals"]), "f4", -1, 3)


def pixel_landscape(keywords: dict[str, Any]) -> dict[str, Any]:
    light = keywords["light"]
    given = {**keywords, "light": turn_light({"light": light, "angles": None}).ravel() if isinstance(light, str) else light}
    made = called(_js.pixelLandscape, given)
    shapes = {"objective": (keywords["side"], keywords["side"]), "minima": (-1, 5), "path": (-1, 3)}
    return {name: array(getattr(made, name), "f4", *shape) for name, shape in shapes.items()}


def shade_lamp(keywords: dict[str, Any]) -> Any:
    return array(called(_js.shadeLamp, keywords["lamp"], keywords["normals"]), "f4", -1)


def bas_relief(keywords: dict[str, Any]) -> dict[str, Any]:
    made = called(_js.basRelief, *(keywords[name] for name in ("normals", "lamp", "stretch", "right", "down")))
    return {"normals": array(made.normals, "f4", -1, 3), "albedo": array(made.albedo, "f4", -1), "lamp": array(made.lamp, "f8", 3)}


def second_order(keywords: dict[str, Any]) -> Any:
    return array(called(_js.secondOrder, keywords["intensity"]), "f4", -1)


def characteristic_strips(keywords: dict[str, Any]) -> list[Any]:
    return [array(strip, "f4", -1, 3) for strip in called(_js.characteristicStrips, keywords)]


def sample_rig(keywords: dict[str, Any]) -> dict[str, Any]:
    made = called(_js.sampleRig, keywords)
    return {**rig_views(made), "name": f"{keywords['kind']} {(keywords['frame'] or 0) + 1}"}


def sample_pair(keywords: dict[str, Any]) -> dict[str, Any]:
    return {**rig_views(called(_js.samplePair, keywords["kind"])), "name": keywords["kind"]}


def rig_views(made: Any) -> dict[str, Any]:
    return {"image": view(made.image, "u1", [4]), "depth": view(made.depth, "u2", [], 0.001), "pose": objects(made.pose)}


def suggest_mask(keywords: dict[str, Any]) -> dict[str, Any]:
    height, width = keywords["height"], keywords["width"]
    made = called(_js.suggestMask, keywords["data"], keywords["marks"], width, height)
    numbers = {name: getattr(made, name) for name in ("share", "rounds", "changed")}
    return {"mask": array(made.mask, "u1", height, width) != 0, **numbers}


def unsupported(name: str) -> NoReturn:
    raise BimodalError("unsupported", f"{name}: files are read and written by the native package only, not in Pyodide", name)


def depth_png(keywords: dict[str, Any], is_metric: bool) -> NoReturn:
    unsupported("write_depth")


def matrix_text(value: Any) -> NoReturn:
    unsupported("write_pose")


def check_command(arguments: list[str], write: Any, write_error: Any, is_terminal: bool) -> NoReturn:
    unsupported("check")


def read_image(path: str) -> NoReturn:
    unsupported("read_image")


def read_depth(path: str, unit: Optional[float], is_metric: bool) -> NoReturn:
    unsupported("read_depth")


def read_mask(path: str) -> NoReturn:
    unsupported("read_mask")


def read_calibration(path: str) -> NoReturn:
    unsupported("read_calibration")


def read_rig_folder(path: str, unit: Optional[float], frames: Optional[int], camera_files: list[str]) -> NoReturn:
    unsupported("read_rig_folder")
