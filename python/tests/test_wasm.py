"""Compares native numbers with those of the wasm build, on the same bytes.

Both run the same source, but functions of the standard library differ in their last digit, as does the order of some sums.
"""

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import bimodal_stereo as bimodal

HERE = Path(__file__).parent
PKG = HERE.parents[1] / "pkg" / "index.js"
NODE = shutil.which("node")
pytestmark = pytest.mark.skipif(NODE is None or not PKG.exists(), reason="needs Node and the package in pkg/ (npm run build)")

# Far away, so that an orthographic scene is nearly what the camera sees: a millimetre per pixel at a distance of a metre.
FOCAL = 1000.0
CAMERA = bimodal.Pinhole(FOCAL, FOCAL, 23.5, 23.5)


def rendered():
    """Linear floats, float depths, everything known but the pose."""
    scene = bimodal.sample("bust", "colourful", size=32)
    options = {"light": scene.light, "start": "identity", "scale": 1.0}
    return scene.image, scene.depth, options, 4


def encoded():
    """8-bit levels, 16-bit depths in tenths of a millimetre, cameras, nothing known."""
    scene = bimodal.sample("bust", "colourful", size=48)
    colours = np.asarray(scene.image.data)
    levels = (250 * (colours / colours.max()) ** (1 / 2.2)).round().astype(np.uint8)
    pixels = np.asarray(scene.depth.data)
    tenths = (10 * (pixels - np.nanmean(pixels) + FOCAL)).round()
    image = bimodal.ColorImage(levels, scene.image.mask, CAMERA)
    depth = bimodal.DepthMap(np.nan_to_num(tenths).astype(np.uint16), mask=scene.depth.mask, camera=CAMERA, unit=1e-4)
    return image, depth, {"max_iterations": 4}, 100_000


def cloud():
    """An organised cloud with its normals, in the paper's own loop."""
    scene = bimodal.sample("vase", "overcast", protocol="grid", angles={"beta": 10})
    return scene.image, scene.depth, {"start": "identity", "registration": "icp", "shading": "pixel"}, 3


def of_javascript(folder, name, view):
    """A view in the JavaScript package's form: flat arrays in files, RGBA for integer colours."""
    data = np.asarray(view.data if view.data is not None else view.points)
    members = {"height": data.shape[0], "width": data.shape[1]}
    if name == "image" and data.dtype == np.uint8:
        data = np.dstack([data, np.full(data.shape[:2], 255, np.uint8)])
    arrays = {"data" if view.data is not None else "points": data, "mask": np.asarray(view.mask).astype(np.uint8)}
    if getattr(view, "normals", None) is not None:
        arrays["normals"] = np.asarray(view.normals)
    for member, array in arrays.items():
        file = f"{name}-{member}.in"
        (folder / file).write_bytes(array.tobytes())
        members[member] = {"file": file, "kind": array.dtype.str[1:]}
    if view.camera is not None:
        members["camera"] = {**vars(view.camera), "distortion": list(view.camera.distortion)}
    if getattr(view, "unit", None) is not None:
        members["unit"] = view.unit
    return members


SPELLED = {"max_iterations": "maxIterations"}


def by_wasm(folder, image, depth, options, steps):
    spelled = {SPELLED.get(name, name): np.ravel(value).tolist() if name == "light" else value for name, value in options.items()}
    views = {name: of_javascript(folder, name, view) for name, view in (("image", image), ("depth", depth))}
    (folder / "case.json").write_text(json.dumps({**views, "options": spelled, "steps": steps}))
    subprocess.run([NODE, HERE / "by_wasm.mjs", folder], check=True, timeout=600)
    return json.loads((folder / "report.json").read_text())


# Absolute, in any unit: normals and logarithms have none, depths are in pixels or metres. Some ten thousand times the rounding of
# 32 bits, because each iteration continues from the last one's rounding. A wrong transfer curve or a wrong unit changes the first digits.
TOLERANCE = 1e-3
# A rotation is computed from all pixels together, in 64 bits.
ROUNDING = 1e-5

RASTERS = {
    "image_normals": "imageNormals",
    "image_depth": "imageDepth",
    "depth_normals": "depthNormals",
    "refined_depth": "refinedDepth",
    "residual": "residual",
    "albedo": "albedo",
    "shading": "shading",
}


@pytest.mark.parametrize("case", [rendered, encoded, cloud])
def test_native_and_wasm_agree(case, tmp_path):
    image, depth, options, steps = case()
    theirs = by_wasm(tmp_path, image, depth, options, steps)
    estimator = bimodal.Estimator(image, depth, **options)
    ours = estimator.run(steps)

    def numbers(name, kind):
        return np.frombuffer((tmp_path / f"{name}.out").read_bytes(), kind)

    assert (ours.status, ours.iteration, ours.stage) == (theirs["status"], theirs["iteration"], theirs["stage"])
    near(ours.pose.rotation.ravel(), theirs["pose"]["rotation"], ROUNDING)
    near(ours.pose.translation, theirs["pose"]["translation"], TOLERANCE)
    near(ours.residual, theirs["residual"], TOLERANCE)
    near(estimator.light().ravel(), numbers("light", np.float64), TOLERANCE)
    for name, their_name in RASTERS.items():
        near(getattr(estimator, name)().ravel(), numbers(their_name, np.float32), TOLERANCE, name)
    for view in ("image", "depth"):
        near(estimator.points(view).ravel(), numbers(f"points-{view}", np.float32), TOLERANCE, view)
    # A point on the edge between two pixels may fall on either.
    same = estimator.correspondence().ravel() == numbers("correspondence", np.int32)
    assert same.mean() > 0.99


def near(ours, theirs, tolerance, name="pose"):
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=tolerance, equal_nan=True, err_msg=name)
