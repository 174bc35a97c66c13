"""What a type checker makes of the package; nothing here runs. `mypy --strict` finds an error where one is expected, and no other."""

from typing import Optional

import numpy as np
from numpy.typing import NDArray

from bimodal_stereo import ColorImage, DepthMap, Estimator, Pinhole, StepReport, check_calibration, read_calibration, read_rig_folder, sample, sample_rig

camera = Pinhole(500, 500, 320, 240, [0.1, 0, 0, 0, 0])
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

Estimator(image, depth, ligth="estimate")  # type: ignore[call-arg]
Estimator(image, depth, max_iterations="many")  # type: ignore[arg-type]
Estimator(image, depth, lambda_={"shape": 1})  # type: ignore[typeddict-unknown-key]
Pinhole(500, 500, 320)  # type: ignore[call-arg]
Estimator.restore("state")  # type: ignore[arg-type]
estimator.points("image").shape.total  # type: ignore[attr-defined]
