"""Files of a rig: calibrations, folders of frames, and the command that checks them."""

import json
import subprocess
import sys

import numpy as np
import pytest

import bimodal_stereo as bimodal
from bimodal_stereo import __main__ as command

INTRINSICS = {"fx": 300.0, "fy": 300.0, "cx": 23.5, "cy": 17.5}


@pytest.fixture(scope="module")
def rig():
    return bimodal.sample_rig("objects", seed=3)


@pytest.fixture
def folder(tmp_path, rig):
    """A rendered frame as files, with its cameras and extrinsics."""
    frames = tmp_path / "frames"
    frames.mkdir()
    np.save(frames / "color_1.npy", rig.image.data)
    np.save(frames / "depth_1.npy", rig.depth.data)
    cameras = {}
    for name, view in {"color": rig.image, "depth": rig.depth}.items():
        camera = view.camera
        cameras[name] = {key: getattr(camera, key) for key in ("fx", "fy", "cx", "cy")}
        cameras[name]["distortion"] = list(camera.distortion)
    (frames / "cameras.json").write_text(json.dumps(cameras))
    matrix = np.column_stack([rig.pose.rotation, rig.pose.translation])
    np.savetxt(tmp_path / "extrinsics.txt", np.vstack([matrix, [0, 0, 0, 1]]))
    return tmp_path


def test_a_calibration_has_cameras_and_poses(tmp_path):
    path = tmp_path / "rig.json"
    path.write_text(json.dumps({"rgb": INTRINSICS, "R": np.eye(3).tolist(), "t": [0.1, 0, 0]}))
    found = bimodal.read_calibration(path)
    assert (found.cameras[0].name, found.cameras[0].camera.fx, found.cameras[0].size) == ("rgb", 300.0, None)
    np.testing.assert_allclose(found.poses[0].pose.translation, [0.1, 0, 0])
    assert found.warnings == [] and "JSON" in found.says


def test_what_is_no_calibration_is_an_error(tmp_path):
    path = tmp_path / "rig.json"
    path.write_text("{}")
    for bad in (path, tmp_path / "nowhere.json"):
        with pytest.raises(bimodal.BimodalError) as caught:
            bimodal.read_calibration(bad)
        assert caught.value.code == "file" and bad.name in str(caught.value)


def test_a_folder_is_what_the_check_takes(folder, rig):
    found = bimodal.read_rig_folder(folder / "frames", unit=0.001)
    (frame,) = found.frames
    np.testing.assert_array_equal(frame.image.data[..., :3], np.asarray(rig.image.data)[..., :3])
    np.testing.assert_array_equal(frame.depth.data, rig.depth.data)
    assert frame.image.camera == rig.image.camera or frame.image.camera.fx == rig.image.camera.fx
    assert found.warnings == [] and [camera.name for camera in found.cameras] == ["color", "depth"]
    guessed = bimodal.read_rig_folder(folder / "frames")
    assert [warning.code for warning in guessed.warnings] == ["unit-guessed"]


def test_the_command_checks_a_folder(folder, capsys):
    frames, extrinsics = str(folder / "frames"), str(folder / "extrinsics.txt")
    report = folder / "report.json"
    code = command.main(["check", frames, "--calibration", extrinsics, "--unit", "0.001", "--json", str(report)])
    said = capsys.readouterr()
    found = json.loads(report.read_text())
    assert (code, found["verdict"], found["warnings"]) == (0, "consistent", []), said.out
    assert said.out.startswith("CONSISTENT: ") and "100 %" in said.err
    assert command.main(["check", frames]) == 3 and "--calibration" in capsys.readouterr().err
    assert command.main(["chekc"]) == 3 and command.main(["--version"]) == 0


def test_the_module_is_a_program():
    ran = subprocess.run([sys.executable, "-m", "bimodal_stereo", "check", "--help"], capture_output=True, text=True, check=False)
    assert ran.returncode == 0 and "Exit code: 0 consistent" in ran.stdout
    assert subprocess.run([sys.executable, "-m", "bimodal_stereo"], capture_output=True, text=True, check=False).stdout == command.HELP
