"""Written files, read by other programs."""

import json

import numpy as np
import pytest
from PIL import Image

import bimodal_stereo as bimodal
from conftest import refused


def test_results_are_files_that_others_read(near, tmp_path):
    estimator = near()
    report = estimator.run()
    written = bimodal.write_results(estimator, tmp_path / "run")
    names = ["clouds.ply", "refined-depth.png", "refined-depth.npy", "pose.json", "depth_to_colour.txt", "light.csv"]
    assert sorted(path.name for path in (tmp_path / "run").iterdir()) == sorted(names)
    assert [line.split(" (")[0] for line in written] == [str(tmp_path / "run" / name) for name in names]
    np.testing.assert_array_equal(np.load(tmp_path / "run/refined-depth.npy"), estimator.refined_depth())
    np.testing.assert_array_equal(np.loadtxt(tmp_path / "run/depth_to_colour.txt"), report.pose.matrix)
    told = json.loads((tmp_path / "run/pose.json").read_text())
    assert told["unit"] == "px" and told["matrix"] == report.pose.matrix.tolist() and told["status"] == report.status
    light = np.loadtxt(tmp_path / "run/light.csv", delimiter=",", skiprows=1, usecols=range(1, 10))
    np.testing.assert_array_equal(light, estimator.light())
    image = np.asarray(Image.open(tmp_path / "run/refined-depth.png"))
    depth = np.nan_to_num(estimator.refined_depth())
    assert (abs(image / 1000 - depth) <= 0.0006).all()


def test_results_go_nowhere_but_to_a_folder(near, tmp_path):
    (tmp_path / "taken").write_text("")
    with pytest.raises(bimodal.BimodalError, match="taken") as caught:
        bimodal.write_results(near(), tmp_path / "taken")
    assert caught.value.code == "file"


def test_a_pose_is_read_back(tmp_path):
    pose = bimodal.sample("bust", "window", size=32, angles={"beta": 30, "gamma": 7}).pose
    path = tmp_path / "pose.txt"
    for form in (pose, pose.matrix, {"angles": {"beta": 30, "gamma": 7}, "translation": pose.translation}):
        bimodal.write_pose(path, form)
        np.testing.assert_allclose(np.loadtxt(path), pose.matrix, rtol=0, atol=1e-15)
    metric = np.eye(4)
    metric[:3, 3] = [0.1, -0.02, 0.003]
    bimodal.write_pose(path, metric)
    np.testing.assert_array_equal(bimodal.read_calibration(path).poses[0].pose.matrix, metric)
    refused(lambda: bimodal.write_pose(path, {"translation": [0, 0, 0]}), "missing", "pose.rotation")
    refused(lambda: bimodal.write_pose(path, {"rotation": 2 * np.eye(3), "translation": [0, 0, 0]}), "range", "pose.rotation")


def test_depths_are_stored_by_the_finest_step_that_reaches_them(tmp_path):
    path = tmp_path / "depth.png"
    depth = np.array([[0.5, np.nan, 0.0], [1.23456, 1e13, 2.0]])
    assert bimodal.write_depth(path, depth) == "0.1 mm"
    np.testing.assert_array_equal(np.asarray(Image.open(path)), [[5000, 0, 0], [12346, 0, 20000]])
    assert Image.open(path).text["Unit"] == "0.1 mm per stored number; 0 is no depth"
    assert bimodal.write_depth(path, 20 * depth) == "1 mm"
    assert bimodal.write_depth(path, depth, "px") == "0.001 px"
    again = bimodal.read_depth(path, unit=0.001)
    np.testing.assert_array_equal(again.data[1], [1235, 0, 2000])
    refused(lambda: bimodal.write_depth(path, [[-1.0]], "px"), "range", "depth")
    refused(lambda: bimodal.write_depth(path, [[1.0, 70_000.0]]), "range", "depth")
    refused(lambda: bimodal.write_depth(path, [1.0]), "size", "depth")
    refused(lambda: bimodal.write_depth(path, np.zeros((0, 3))), "size", "depth")
    refused(lambda: bimodal.write_depth(path, [[1.0]], "mm"), "option", "unit")


def test_clouds_are_binary_ply(tmp_path):
    path = tmp_path / "cloud.ply"
    points = np.array([[[1, 2, 3], [np.nan, 0, 0]], [[4, 5, 6], [7, 8, 9]]], np.float32)
    bimodal.write_cloud(path, points)
    header, body = path.read_bytes().split(b"end_header\n")
    assert b"element vertex 3\nproperty float x\nproperty float y\nproperty float z\n" in header
    np.testing.assert_array_equal(np.frombuffer(body, "<f4").reshape(-1, 3), [[1, 2, 3], [4, 5, 6], [7, 8, 9]])
    bimodal.write_cloud(path, points, np.full(points.shape, 0.5))
    header, body = path.read_bytes().split(b"end_header\n")
    assert header.endswith(b"property uchar blue\n") and len(body) == 3 * 15 and body[12:15] == bytes([128] * 3)
    bimodal.write_cloud(path, points, np.full(points.shape, 7, np.uint8))
    assert path.read_bytes().endswith(bytes([7] * 3))
    refused(lambda: bimodal.write_cloud(path, [1, 2, 3]), "size", "points")
    refused(lambda: bimodal.write_cloud(path, points, [[1, 2, 3]]), "size", "colours")
