"""The stages in numpy and scipy that `npm run bench -- --beside` times beside the package."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import bimodal_stereo as bimodal

FOLDER = Path(__file__).parents[2] / "scripts/reference/beside"
STAGES = {"preparation", "light", "shading", "surface", "registration", "refinement", "step"}


def write(path, scene):
    """A file as scripts/bench/scenes.mjs writes it: sides, pose, colours and depth, NaN off the masks."""
    colours = np.where(np.asarray(scene.image.mask)[..., None], scene.image.data, np.nan)
    height, width = colours.shape[:2]
    pose = np.concatenate([[scene.pose.scale], np.ravel(scene.pose.rotation), scene.pose.translation])
    views = [np.ravel(view).astype("<f4").tobytes() for view in (colours, scene.depth.data)]
    path.write_bytes(b"".join([np.array([width, height], "<u4").tobytes(), pose.astype("<f8").tobytes(), *views]))


def test_the_stages_in_numpy_and_scipy_find_the_pose(tmp_path):
    pytest.importorskip("scipy", reason="needs scipy: pip install scipy")
    write(tmp_path / "scene.bin", bimodal.sample("bust", "window", size=64, angles={"beta": 30}, noise=0.01))
    requests = f"scene {tmp_path / 'scene.bin'}\nstep\nanswer\n"
    command = [sys.executable, "-W", "error::RuntimeWarning", FOLDER]
    result = subprocess.run(command, input=requests, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
    _, _, step, answer = map(json.loads, result.stdout.splitlines())
    assert STAGES <= set(step["milliseconds"])
    # Both are a single run on a small view, which rarely determines a pose to less than one degree.
    assert step["degrees"] < 2 and answer["degrees"] < 2
