"""Every line of code in the README, run in order, on files and arrays like those that it mentions."""

import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import bimodal_stereo as bimodal

README = (Path(__file__).parents[1] / "README.md").read_text()
BLOCKS = re.findall(r"^```python\n(.*?)^```", README, re.MULTILINE | re.DOTALL)


# At this distance, in millimetres and pixels, an orthographic scene is nearly what a camera sees.
FOCAL = 600.0
# True beta of the pose after each block, degrees.
BETA = {0: 50, 1: 20, 2: 20, 4: 20, 5: 20}


class Intrinsics:
    """Intrinsics of a stream, in librealsense's form."""

    fx = fy = FOCAL
    ppx = ppy = 31.5
    coeffs = [0.0, 0.0, 0.0, 0.0, 0.0]


def levels(scene):
    """A scene's colours as 8-bit levels, and its depth in tenths of a millimetre."""
    colours = np.asarray(scene.image.data)
    pixels = np.asarray(scene.depth.data)
    tenths = np.nan_to_num(10 * (pixels - np.nanmean(pixels) + FOCAL)).round().astype(np.uint16)
    return (250 * (colours / colours.max()) ** (1 / 2.2)).round().astype(np.uint8), tenths


@pytest.fixture(scope="module")
def lines(tmp_path_factory):
    """Names shared by the blocks, in a folder with the files that they read."""
    folder = tmp_path_factory.mktemp("readme")
    scene = bimodal.sample("bust", "colourful", size=64)
    colours, tenths = levels(scene)
    Image.fromarray(colours).save(folder / "image.png")
    Image.fromarray((255 * scene.image.mask).astype(np.uint8)).save(folder / "mask.png")
    Image.fromarray((tenths // 10).astype(np.uint16)).save(folder / "depth.png")
    rows, columns = np.indices(tenths.shape)
    middle = np.array([0, 0, FOCAL / 1000])
    z = np.where(tenths > 0, tenths * 1e-4, np.nan)
    return folder, {
        "bgr": np.ascontiguousarray(colours[..., ::-1]),
        "colour_mask": scene.image.mask,
        "z16": tenths,
        "depth_scale": 1e-4,
        "colour_intrinsics": Intrinsics,
        "depth_intrinsics": Intrinsics,
        "rotation": scene.pose.rotation,
        # Keeps the object's middle in place.
        "translation": middle - scene.pose.rotation @ middle,
        "cloud_of_rows": np.dstack([(columns - 31.5) / FOCAL * z, (rows - 31.5) / FOCAL * z, z]),
    }


@pytest.mark.parametrize("at", range(len(BLOCKS)))
def test_the_readme_does_what_it_says(at, lines, monkeypatch):
    block = BLOCKS[at]
    if "open3d" in block:
        pytest.importorskip("open3d", reason="needs open3d, 1.3 GB: pip install open3d", exc_type=ImportError)
    folder, names = lines
    monkeypatch.chdir(folder)
    exec(compile(block, "python/README.md", "exec"), names)
    if at in BETA:
        report = names["estimator"].report
        assert report.pose.angles.beta == pytest.approx(BETA[at], abs=3), report


def test_every_block_is_told():
    assert len(BLOCKS) == README.count("```") // 2 - README.count("```sh") == 10
