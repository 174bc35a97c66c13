"""What independent readers find in the files of tests/fixtures/run, and arrays in column order as numpy writes them.

npm run build && node scripts/reference/run-written.mjs && python3 scripts/reference/run-written.py

numpy, Pillow, OpenCV and Open3D (pip install numpy pillow opencv-python-headless open3d). Open3D reads the PLY, Pillow and OpenCV the PNG,
numpy the .npy and the pose's matrix; the pose is also read by json, and applied to points by Open3D. Writes tests/fixtures/run/read.json
with the results, and columns-*.npy there, whose numbers in row order it also holds. Fails where two readers disagree.

With a folder of files that the Lab's "Download" has saved, it reads all of them and prints what they contain:

python3 scripts/reference/run-written.py FOLDER
"""

import json
import sys
from pathlib import Path

sys.path.pop(0)  # this file's folder, in which "open3d" would be another file

import cv2
import numpy as np
import open3d as o3d
from PIL import Image

FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else "tests/fixtures/run")
o3d.utility.set_verbosity_level(o3d.utility.VerbosityLevel.Error)


def plain(values):
    """Numbers as JSON has them; a value that is not finite becomes its name."""
    flat = np.asarray(values, dtype=np.float64).ravel()
    return [float(value) if np.isfinite(value) else str(value) for value in flat]


def raster(values):
    return {"shape": list(values.shape), "type": str(values.dtype), "values": plain(values)}


def png(name):
    path = str(FOLDER / name)
    by_cv = cv2.imread(path, cv2.IMREAD_UNCHANGED)
    with Image.open(path) as image:
        by_pillow, texts = np.array(image), dict(image.text)
    if by_cv.ndim == 3:
        by_cv = by_cv[..., ::-1]
    # Pillow has no 16-bit colours; it keeps their high bytes.
    same = by_cv >> 8 if by_cv.ndim == 3 and by_cv.dtype == np.uint16 else by_cv
    assert np.array_equal(same, by_pillow), name
    return {**raster(by_cv), "texts": texts}


def cloud(name):
    read = o3d.io.read_point_cloud(str(FOLDER / name))
    tensor = o3d.t.io.read_point_cloud(str(FOLDER / name))
    assert np.array_equal(np.asarray(read.points, dtype=np.float32), tensor.point.positions.numpy())
    comments = [line for line in (FOLDER / name).read_bytes().split(b"end_header")[0].decode().split("\n") if line.startswith("comment")]
    return {"points": plain(read.points), "colours": plain(np.round(255 * np.asarray(read.colors))), "labels": plain(tensor.point["label"].numpy()), "comments": comments}


def pose():
    by_json = json.loads((FOLDER / "pose.json").read_text())
    by_numpy = np.loadtxt(FOLDER / "depth_to_colour.txt")
    composed = np.eye(4)
    composed[:3, :3] = by_json["scale"] * np.reshape(by_json["rotation"], (3, 3))
    composed[:3, 3] = by_json["translation"]
    assert np.array_equal(by_numpy, composed) and np.array_equal(by_numpy, by_json["matrix"])
    turned = o3d.geometry.PointCloud(o3d.utility.Vector3dVector([[0.1, -0.2, 0.7]])).transform(by_numpy)
    return {"matrix": by_numpy.tolist(), "unit": by_json["unit"], "moved": plain(turned.points)}


def columns():
    """Arrays in column order, and the same numbers in row order."""
    made = {
        "columns-depth.npy": np.linspace(0.5, 2, 12, dtype=np.float32).reshape(3, 4),
        "columns-double.npy": np.linspace(-1, 2, 12).reshape(4, 3),
        "columns-cloud.npy": np.arange(24, dtype=np.float32).reshape(2, 4, 3),
        "columns-levels.npy": (np.arange(15, dtype=np.uint16) * 4369).reshape(5, 3),
        "columns-colour.npy": np.arange(36, dtype=np.uint8).reshape(3, 4, 3),
        "columns-mask.npy": (np.arange(12) % 5 < 2).reshape(4, 3),
    }
    for name, values in made.items():
        np.save(FOLDER / name, np.asfortranarray(values))
        assert np.load(FOLDER / name).flags.f_contiguous, name
    return {name: raster(values) for name, values in made.items()}


def saved():
    """Compares the files that the Lab has saved with each other."""
    matrix = np.array(pose()["matrix"])
    print("pose: JSON and 4x4 agree, determinant of the turn and scale", np.linalg.det(matrix[:3, :3]))
    points = np.array(cloud("clouds.ply")["points"]).reshape(-1, 3)
    labels = np.array(cloud("clouds.ply")["labels"])
    print("clouds:", [int((labels == each).sum()) for each in (0, 1)], "points, all finite:", bool(np.isfinite(points).all()))
    stored, exact = png("refined-depth.png"), np.load(FOLDER / "refined-depth.npy")
    number, unit = stored["texts"]["Unit"].split(" ")[:2]
    step = float(number) * (0.001 if unit == "mm" else 1)
    depth = np.array(stored["values"]).reshape(stored["shape"]) * step
    there = np.isfinite(exact) & (exact > 0)
    assert np.array_equal(depth > 0, there)
    print(f"depth: {there.sum()} pixels of {exact.shape}, PNG and .npy differ by {np.abs(depth - exact)[there].max() / step:.3f} of a step of {number} {unit}")
    for name in ("normals.png", "refined-normals.png"):
        read = png(name)
        levels = np.array(read["values"]).reshape(read["shape"])
        normals = 2 * levels[levels.any(axis=2)] / 65535 - 1
        lengths = np.linalg.norm(normals, axis=1)
        assert np.abs(lengths - 1).max() < 1e-4 and (normals[:, 2] >= -1e-4).all()
        print(f"{name}: {len(normals)} of unit length, towards the viewer")
    print("light:", np.loadtxt(FOLDER / "light.csv", delimiter=",", skiprows=1, usecols=range(1, 10)).shape)


def fixtures():
    found = {
        **{path.name: png(path.name) for path in sorted(FOLDER.glob("*.png"))},
        **{path.name: cloud(path.name) for path in sorted(FOLDER.glob("*.ply"))},
        **{path.name: raster(np.load(path)) for path in sorted(FOLDER.glob("*.npy")) if not path.name.startswith("columns")},
        "light.csv": {"values": plain(np.loadtxt(FOLDER / "light.csv", delimiter=",", skiprows=1, usecols=range(1, 10)))},
        "pose": pose(),
        **columns(),
    }
    lines = [f"{json.dumps(name)}: {json.dumps(each)}" for name, each in found.items()]
    (FOLDER / "read.json").write_text("{\n" + ",\n".join(lines) + "\n}\n")
    print(f"{len(found)} files read")


saved() if len(sys.argv) > 1 else fixtures()
