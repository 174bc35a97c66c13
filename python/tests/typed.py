"""The package under a type checker; nothing here runs. `mypy --strict` must find the expected errors and no others."""

from pathlib import Path
from typing import Optional

import numpy as np
from numpy.typing import NDArray

from bimodal_stereo import ColorImage, DepthMap, Estimator, Pinhole, StepReport, check_calibration, integrate_normals, project_frame
from bimodal_stereo import read_calibration, read_depth, read_rig_folder, sample, sample_bound, sample_rig, shade_normals, turn_light
from bimodal_stereo import write_depth, write_results

camera = Pinhole(500, 500, 320, 240, [0.1, 0, 0, 0, 0])
fisheye = Pinhole(500, 500, 320, 240, [0.1, 0, 0, 0], model="fisheye")
image = ColorImage(np.zeros((480, 640, 3), np.uint8), mask=np.ones((480, 640)), camera=camera, transfer="srgb")
depth = DepthMap(np.zeros((480, 640), np.uint16), camera=camera, unit=0.001)
estimator = Estimator(image, depth, start={"angles": {"beta": 3}}, lambda_={"prior": 0.1}, max_iterations=3)
report: StepReport = estimator.run(3, on_step=lambda step: print(step.message))
message: Optional[str] = report.message
normals: NDArray[np.float32] = estimator.image_normals()
indices: NDArray[np.int32] = estimator.correspondence()
light: NDArray[np.float64] = estimator.light()
state: bytes = estimator.save()
restored: Estimator = Estimator.restore(state)
beta: float = sample("bust", "window", angles={"beta": 20}).pose.angles.beta
rig = sample_rig("room")
assert rig.pose is not None
verdict: str = check_calibration([rig], {"factory": rig.pose}, cues=["edges"]).verdict
folder = read_rig_folder("frames", unit=0.001, cameras=["rgb.yaml"])
verdict = check_calibration(folder.frames, {"mine": read_calibration("rig.json").poses[0].pose}).verdict
matrix: NDArray[np.float64] = camera.K
for step in Estimator(Path("image.png"), "depth.png", start=np.eye(4), workers=2):
    matrix = step.pose.matrix if step.pose.matrix is not None else matrix
project_frame(rig, matrix).edges.shape
ColorImage(np.zeros((4, 4)), mask="mask.png", camera={"K": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "distortion": [0] * 5})
read_depth("depth.png", camera=matrix, unit=0.001).data
light = turn_light("window", {"beta": 3})
normals = shade_normals(light, integrate_normals(normals))
says: str = write_depth(Path("depth.png"), estimator.refined_depth())
lines: list[str] = write_results(estimator, "results")
bound: Optional[float] = sample_bound("bust", light, light_is_known=True, noise=0.01)

Estimator(image, depth, ligth="estimate")  # type: ignore[call-arg]
Estimator(image, depth, max_iterations="many")  # type: ignore[arg-type]
Estimator(image, depth, lambda_={"shape": 1})  # type: ignore[typeddict-unknown-key]
Pinhole(500, 500, 320)  # type: ignore[call-arg]
Estimator.restore("state")  # type: ignore[arg-type]
estimator.points("image").shape.total  # type: ignore[attr-defined]
Estimator(3.5j, depth, workers="all")  # type: ignore[arg-type]
sample_bound("bust", "window")  # type: ignore[call-arg]
