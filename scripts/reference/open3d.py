"""Baseline of Table 2B: the same scenes through Open3D (FPFH, RANSAC, point-to-plane ICP), pose unknown, light known.

npm run build && python3 scripts/reference/open3d.py > scripts/reference/open3d.csv

Registers the depth map's cloud to the surface that shading gives for the image (open3d-scenes.mjs). Open3D 0.20 and numpy.
One thread, because with more the result of RANSAC depends on which finishes first. Lengths are pixels.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"
sys.path.pop(0)  # removes this file's folder, where the name "open3d" would find this file

import numpy as np
import open3d as o3d

VOXEL = {128: 1.5, 64: 1.0}  # features are computed on a thinned cloud; the best of three pairs of sizes
NORMAL_VOXELS, FEATURE_VOXELS, MATCH_VOXELS = 2, 5, 1.5  # radii, as Open3D recommends
RANSAC = (100_000, 0.999)
SEEDS = range(1, 6)  # the seed that matches most points is refined
ICP_DISTANCES = (4.0, 2.0, 1.0)
registration = o3d.pipelines.registration
o3d.utility.set_verbosity_level(o3d.utility.VerbosityLevel.Error)  # warnings go to stdout, where the figures are


def cloud(points, normals=None):
    made = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points.astype(np.float64)))
    if normals is not None:
        made.normals = o3d.utility.Vector3dVector(normals.astype(np.float64))
    return made


def features(full, voxel):
    thin = full.voxel_down_sample(voxel)
    near = o3d.geometry.KDTreeSearchParamHybrid(radius=FEATURE_VOXELS * voxel, max_nn=100)
    return thin, registration.compute_fpfh_feature(thin, near)


def start(source, target, voxel):
    (thin_source, source_features), (thin_target, target_features) = features(source, voxel), features(target, voxel)
    distance = MATCH_VOXELS * voxel
    checks = [
        registration.CorrespondenceCheckerBasedOnEdgeLength(0.9),
        registration.CorrespondenceCheckerBasedOnDistance(distance),
    ]
    found = []
    for seed in SEEDS:
        o3d.utility.random.seed(seed)
        found.append(
            registration.registration_ransac_based_on_feature_matching(
                thin_source, thin_target, source_features, target_features, True, distance,
                registration.TransformationEstimationPointToPoint(False), 3, checks,
                registration.RANSACConvergenceCriteria(*RANSAC),
            )
        )
    return max(found, key=lambda result: (result.fitness, -result.inlier_rmse)).transformation


def register(image, depth, size):
    voxel = VOXEL[size]
    target, source = cloud(image[:, :3], image[:, 3:]), cloud(depth)
    source.estimate_normals(o3d.geometry.KDTreeSearchParamHybrid(radius=NORMAL_VOXELS * voxel, max_nn=30))
    source.orient_normals_to_align_with_direction([0.0, 0.0, -1.0])
    pose = start(source, target, voxel)
    for distance in ICP_DISTANCES:
        plane = registration.TransformationEstimationPointToPlane()
        pose = registration.registration_icp(source, target, distance, pose, plane).transformation
    return pose[:3, :3]


def degrees_between(a, b):
    return np.degrees(2 * np.arcsin(min(1, np.linalg.norm(a - b) / np.sqrt(8))))


with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    subprocess.run(["node", Path(__file__).with_name("open3d-scenes.mjs"), folder], check=True)
    scenes = json.loads((folder / "scenes.json").read_text())
    print("beta,overlap,size,light,degrees")
    for index, scene in enumerate(scenes):
        image = np.fromfile(folder / f"{index}.image.f32", np.float32).reshape(-1, 6)
        depth = np.fromfile(folder / f"{index}.depth.f32", np.float32).reshape(-1, 3)
        degrees = degrees_between(register(image, depth, scene["size"]), np.reshape(scene["rotation"], (3, 3)))
        print(f"{scene['beta']},{scene['overlap']},{scene['size']},{scene['light']},{degrees:.4f}", flush=True)
        print(f"{index + 1} of {len(scenes)}", file=sys.stderr)
