"""Shape, light and camera pose from one colour image and one depth map of the same object, taken from different viewpoints.

One frame everywhere: x right, y down, z forward; normals face the camera; depth is along z. Without intrinsics a view is
orthographic, its unit is the pixel, and x and y are counted from the centre of the raster; with them it is metric. The pose transforms
depth points into the colour view: P_colour = scale * rotation @ P_depth + translation. Arrays are row by row, (h, w) or
(h, w, 3), and come out as copies.

    from bimodal_stereo import Estimator, sample

    scene = sample("bust", "window", angles={"beta": 50}, noise=0.01)
    report = Estimator(scene.image, scene.depth).run()
    print(report.status, report.pose.angles.beta)
"""

from ._calibration import CandidateReport, CheckFrame, CheckReport, CueReport, FrameOverlay, FrameReport, NextFrame, RigSample, Sensitivity
from ._calibration import check_calibration, project_frame, sample_rig
from ._codes import CODES
from ._errors import BimodalError, BimodalWarning
from ._estimator import Estimator
from ._files import Calibration, NamedCamera, NamedPose, ReaderWarning, RigFolder
from ._files import read_calibration, read_depth, read_image, read_rig_folder
from ._inputs import LightGaussian, Options, StartTolerance, Weights
from ._lessons import BasRelief, PixelLandscape, bas_relief, characteristic_strips, integrate_normals, pixel_landscape, second_order
from ._lessons import shade_lamp, shade_normals, turn_light
from ._native import VERSION as __version__
from ._pairs import MaskSuggestion, PairSample, sample_pair, suggest_mask
from ._samples import Sample, Truth, sample, sample_bound, sample_lights, sample_surfaces
from ._types import Angles, ColorImage, DepthMap, Energy, Pinhole, Pose, StepReport, Uncertainty
from ._write import write_cloud, write_depth, write_pose, write_results

__all__ = [
    "Angles",
    "CODES",
    "BasRelief",
    "BimodalError",
    "BimodalWarning",
    "Calibration",
    "CandidateReport",
    "CheckFrame",
    "CheckReport",
    "ColorImage",
    "CueReport",
    "DepthMap",
    "Energy",
    "Estimator",
    "FrameOverlay",
    "FrameReport",
    "LightGaussian",
    "MaskSuggestion",
    "NamedCamera",
    "NamedPose",
    "NextFrame",
    "Options",
    "PairSample",
    "PixelLandscape",
    "Pinhole",
    "Pose",
    "ReaderWarning",
    "RigFolder",
    "RigSample",
    "Sample",
    "Sensitivity",
    "StartTolerance",
    "StepReport",
    "Truth",
    "Uncertainty",
    "Weights",
    "__version__",
    "bas_relief",
    "characteristic_strips",
    "check_calibration",
    "integrate_normals",
    "pixel_landscape",
    "project_frame",
    "read_calibration",
    "read_depth",
    "read_image",
    "read_rig_folder",
    "sample",
    "sample_bound",
    "sample_lights",
    "sample_pair",
    "sample_rig",
    "sample_surfaces",
    "second_order",
    "shade_lamp",
    "shade_normals",
    "suggest_mask",
    "turn_light",
    "write_cloud",
    "write_depth",
    "write_pose",
    "write_results",
]


def __getattr__(name: str) -> object:
    """``bimodal_stereo.widget``, which needs another package, is imported where it is used."""
    if name == "widget":
        from importlib import import_module

        return import_module(".widget", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
