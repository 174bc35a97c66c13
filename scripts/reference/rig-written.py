"""What independent readers find in the files of tests/fixtures/rig.

npm run build && node scripts/reference/rig-written.mjs && python3 scripts/reference/rig-written.py

OpenCV's FileStorage, PyYAML, Open3D, plyfile, numpy, scipy (the quaternion); librealsense's structure is read from json here, since it
has no reader for such files. Writes tests/fixtures/rig/read.json: for each file the 4x4 matrix that transforms points of the depth camera
into the colour camera's frame, and the cameras that it holds; for clouds their points, colours and labels.
"""

import argparse
import json
import shlex
import sys
from pathlib import Path

sys.path.pop(0)  # this file's folder, in which "open3d" would be another file

import cv2
import numpy as np
import open3d as o3d
import yaml
from plyfile import PlyData
from scipy.spatial.transform import Rotation

FOLDER = Path("tests/fixtures/rig")
o3d.utility.set_verbosity_level(o3d.utility.VerbosityLevel.Error)


def homogeneous(rotation, translation):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation, np.ravel(translation)
    return matrix


def pinhole(matrix, **more):
    (fx, zero, cx), (zero_too, fy, cy), last = np.asarray(matrix).tolist()
    assert [zero, zero_too, last] == [0, 0, [0, 0, 1]], matrix
    return {"fx": fx, "fy": fy, "cx": cx, "cy": cy, **more}


def matrix(path):
    return {"matrix": np.loadtxt(path)}


def opencv(path):
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_READ)
    read = {"matrix": homogeneous(storage.getNode("R").mat(), storage.getNode("T").mat())}
    for name in ("depth", "colour"):
        node = storage.getNode(name)
        if node.empty():
            continue
        size = [node.getNode(f"image_{side}") for side in ("width", "height")]
        read[name] = pinhole(
            node.getNode("camera_matrix").mat(),
            distortion=node.getNode("distortion_coefficients").mat().ravel(),
            model=node.getNode("distortion_model").string(),
            size=None if size[0].empty() else [int(side.real()) for side in size],
        )
    storage.release()
    return read


def kalibr(path):
    chain = yaml.safe_load(path.read_text())
    read = {"matrix": np.array(chain["cam1"]["T_cn_cnm1"])}
    for key, name in (("cam0", "depth"), ("cam1", "colour")):
        camera = chain[key]
        if "intrinsics" not in camera:
            continue
        assert camera["camera_model"] == "pinhole"
        read[name] = {
            **dict(zip(("fx", "fy", "cx", "cy"), camera["intrinsics"], strict=True)),
            "distortion": camera["distortion_coeffs"],
            "model": camera["distortion_model"],
            "size": camera.get("resolution"),
        }
    return read


def ros2(path):
    """The line, parsed as in a shell; tf2 has P_parent = R P_child + t."""
    words = shlex.split(path.read_text(), comments=True)
    assert words[:4] == ["ros2", "run", "tf2_ros", "static_transform_publisher"]
    parser = argparse.ArgumentParser()
    for name in ("x", "y", "z", "qx", "qy", "qz", "qw"):
        parser.add_argument(f"--{name}", type=float, required=True)
    for name in ("frame-id", "child-frame-id"):
        parser.add_argument(f"--{name}", required=True)
    # Python's parser takes "-1.0e-7" for an option, ROS does not.
    joined = [f"{flag}={value}" for flag, value in zip(words[4::2], words[5::2], strict=True)]
    line = parser.parse_args(joined)
    rotation = Rotation.from_quat([line.qx, line.qy, line.qz, line.qw]).as_matrix()
    return {"matrix": homogeneous(rotation, [line.x, line.y, line.z]), "parent": line.frame_id, "child": line.child_frame_id}


def open3d(path):
    read = o3d.io.read_pinhole_camera_parameters(str(path))
    camera = read.intrinsic
    return {"matrix": read.extrinsic, "colour": pinhole(camera.intrinsic_matrix, size=[camera.width, camera.height])}


def realsense(path):
    """rs2_extrinsics: "rotation: column-major 3x3, translation: metres"; rs2_intrinsics by its members' names."""
    rig = json.loads(path.read_text())
    pose = rig["depth_to_color"]
    read = {"matrix": homogeneous(np.reshape(pose["rotation"], (3, 3), order="F"), pose["translation"])}
    for key, name in (("depth", "depth"), ("color", "colour")):
        if key not in rig:
            continue
        camera = rig[key]
        size = [camera["width"], camera["height"]] if "width" in camera else None
        read[name] = {
            **{"fx": camera["fx"], "fy": camera["fy"], "cx": camera["ppx"], "cy": camera["ppy"]},
            **{"distortion": camera["coeffs"], "model": camera["model"], "size": size},
        }
    return read


def cloud(path):
    """Two readers read the cloud; Open3D ignores the label."""
    read = o3d.io.read_point_cloud(str(path))
    vertices = PlyData.read(str(path))["vertex"]
    points = np.stack([vertices[axis] for axis in "xyz"], axis=1)
    colours = np.stack([vertices[name] for name in ("red", "green", "blue")], axis=1)
    assert np.array_equal(points.astype(float), np.asarray(read.points))
    assert np.array_equal(colours, np.rint(np.asarray(read.colors) * 255))
    label = vertices["label"] if "label" in vertices.data.dtype.names else None
    return {"points": points.astype(float), "colours": colours, "label": label}


READERS = {
    "depth_to_colour.txt": matrix,
    "depth_to_colour.opencv.yaml": opencv,
    "camchain.yaml": kalibr,
    "depth_to_colour.ros2.sh": ros2,
    "depth_to_colour.open3d.json": open3d,
    "depth_to_colour.realsense.json": realsense,
    "clouds.ply": cloud,
    "cloud.ply": cloud,
}


def plain(value):
    if isinstance(value, dict):
        return {key: plain(member) for key, member in value.items()}
    return value.tolist() if isinstance(value, np.ndarray) else value


paths = sorted(path for path in FOLDER.rglob("*") if path.is_file() and path.name != "read.json")
found = {path.relative_to(FOLDER).as_posix(): plain(READERS[path.name](path)) for path in paths}
lines = ",\n".join(f"  {json.dumps(name)}: {json.dumps(read)}" for name, read in found.items())
(FOLDER / "read.json").write_text(f"{{\n{lines}\n}}\n")
print(f"read {len(found)} files")
