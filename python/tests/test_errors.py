"""Invalid input is refused by name, and no input aborts the numerics."""

import itertools
import pickle

import numpy as np
import pytest

import bimodal_stereo as bimodal
from conftest import refused

COLOURS = np.full((8, 8, 3), 100, np.uint8)
DEPTHS = np.full((8, 8), 5, np.float32)
CAMERA = {"fx": 100.0, "fy": 100.0, "cx": 4.0, "cy": 4.0}


def image(data=COLOURS, **members):
    return lambda: bimodal.Estimator(bimodal.ColorImage(data, **members), DEPTHS)


def depth(data=DEPTHS, **members):
    return lambda: bimodal.Estimator(COLOURS, bimodal.DepthMap(data, **members))


def options(**given):
    return lambda: bimodal.Estimator(COLOURS, DEPTHS, **given)


BAD = [
    (image(COLOURS[0, 0]), "size", "image.data"),
    (image(COLOURS[..., :2]), "size", "image.data"),
    (image(COLOURS[:0]), "size", "image"),
    (image(COLOURS.astype(np.int64)), "type", "image.data"),
    (image(COLOURS > 3), "type", "image.data"),
    (image("nowhere.png"), "file", "image.data"),
    (image(None), "type", "image.data"),
    (image([[1], [2, 3]]), "type", "image.data"),
    (image(0 * COLOURS), "empty", "image.data"),
    (image(COLOURS * np.float32("nan")), "empty", "image.data"),
    (image(mask=np.ones((8, 9))), "size", "image.mask"),
    (image(mask=np.zeros((8, 8))), "empty", "image.mask"),
    (image(mask="nowhere.png"), "file", "image.mask"),
    (image(transfer="gamma"), "option", "image.transfer"),
    (image(COLOURS.astype(np.float32), transfer="srgb"), "option", "image.transfer"),
    (image(camera=bimodal.Pinhole(**{**CAMERA, "fx": 0})), "range", "image.camera.fx"),
    (image(camera=bimodal.Pinhole(**{**CAMERA, "cy": "middle"})), "type", "image.camera.cy"),
    (image(camera=bimodal.Pinhole(**CAMERA, distortion=[1, 2])), "size", "image.camera.distortion"),
    (image(camera=bimodal.Pinhole(**CAMERA, distortion="none")), "type", "image.camera.distortion"),
    (image(camera=bimodal.Pinhole(**CAMERA, model="round")), "option", "image.camera.model"),
    (image(camera=bimodal.Pinhole(**CAMERA, model="fisheye", distortion=[0] * 5)), "size", "image.camera.distortion"),
    (image(camera=bimodal.Pinhole(**CAMERA, distortion=[0] * 7 + [np.nan])), "range", "image.camera.distortion"),
    (image(camera=bimodal.Pinhole(**CAMERA, distortion=[0] * 3)), "size", "image.camera.distortion"),
    (image(camera={"fx": 100.0}), "missing", "image.camera.fy"),
    (image(camera=np.eye(4)), "size", "image.camera"),
    (image(camera=3), "type", "image.camera"),
    (image(camera=[[100, 1, 4], [0, 100, 4], [0, 0, 1]]), "range", "image.camera"),
    (image(camera=[[100, 0, 4], [0, 100, 4], [1, 0, 1]]), "range", "image.camera"),
    (image(camera=[[0, 0, 4], [0, 100, 4], [0, 0, 1]]), "range", "image.camera.fx"),
    (image(camera={"K": np.eye(3), "fx": 1}), "option", "image.camera.fx"),
    (image(camera={"K": np.eye(2)}), "size", "image.camera.K"),
    (depth(None), "missing", "depth.data"),
    (depth(points=np.ones((8, 8, 3))), "missing", "depth.data"),
    (depth(np.ones((8, 8, 3))), "size", "depth.data"),
    (depth(np.full((8, 8), 70_000)), "range", "depth.data"),
    (depth(np.full((8, 8), -1)), "range", "depth.data"),
    (depth(DEPTHS > 0), "type", "depth.data"),
    (depth(DEPTHS * np.nan), "empty", "depth.data"),
    (depth(unit=0), "range", "depth.unit"),
    (depth(unit="mm"), "type", "depth.unit"),
    (depth(normals=np.ones((8, 8))), "size", "depth.normals"),
    (depth(None, points=np.ones((8, 8))), "size", "depth.points"),
    (lambda: bimodal.Estimator(COLOURS, np.ones(8)), "size", "depth"),
    (lambda: bimodal.Estimator(COLOURS, "nowhere.png"), "file", "depth.data"),
    (options(ligth="estimate"), "option", "ligth"),
    (options(light="candle"), "option", "light"),
    (options(light=[1, 2, 3]), "size", "light"),
    (options(light=[np.nan] * 27), "range", "light"),
    (options(prior=[0] * 27), "type", "prior"),
    (options(prior={"mean": np.zeros(27)}), "missing", "prior.covariance"),
    (options(prior={"mean": np.zeros((3, 9)), "covariance": np.eye(26)}), "size", "prior.covariance"),
    (options(prior={"mean": np.full(27, 200), "covariance": np.eye(27)}), "range", "prior.mean"),
    (options(prior={"mean": np.zeros(27), "covariance": -np.eye(27)}), "range", "prior.covariance"),
    (options(start="here"), "option", "start"),
    (options(start=3), "type", "start"),
    (options(start=np.eye(3)), "size", "start"),
    (options(start=2 * np.eye(4)), "range", "start.matrix"),
    (options(start=np.diag([1, 1, -1, 1])), "range", "start.matrix"),
    (options(start={"rotation": np.ones((3, 3))}), "range", "start.rotation"),
    (options(start={"rotation": np.eye(2)}), "size", "start.rotation"),
    (options(start={"angles": {"beta": 400}}), "range", "start.angles.beta"),
    (options(start={"angle": 3}), "option", "start.angle"),
    (options(start_tolerance={"degrees": 0}), "range", "start_tolerance.degrees"),
    (options(start_tolerance=5), "type", "start_tolerance"),
    (options(registration="rigid"), "option", "registration"),
    (options(registration=1), "type", "registration"),
    (options(shading="flat"), "option", "shading"),
    (options(scale="held"), "option", "scale"),
    (options(scale=-1), "range", "scale"),
    (options(trim="no"), "type", "trim"),
    (options(annealing=0.5), "type", "annealing"),
    (options(lambda_={"prior": -1}), "range", "lambda_.prior"),
    (options(lambda_={"shape": 1}), "option", "lambda_.shape"),
    (options(stop_degrees=float("inf")), "range", "stop_degrees"),
    (options(max_iterations=0), "range", "max_iterations"),
    (options(max_iterations=2**40), "range", "max_iterations"),
    (options(max_iterations=2.5), "type", "max_iterations"),
    (options(correspondence_distance=-1), "range", "correspondence_distance"),
    (options(seed=-1), "range", "seed"),
    (options(seed="lucky"), "type", "seed"),
    (options(workers=17), "range", "workers"),
]


@pytest.mark.parametrize("call, code, field", BAD, ids=[f"{field}-{code}-{at}" for at, (_, code, field) in enumerate(BAD)])
def test_bad_input_is_refused_by_name(call, code, field):
    refused(call, code, field)


def test_what_is_none_is_left_out(near, scene):
    names = bimodal.Options.__annotations__
    bimodal.Estimator(scene.image, scene.depth, **dict.fromkeys(names))


def test_numbers_of_numpy_are_numbers(near):
    near(scale=np.float32(1), max_iterations=np.uint8(3), trim=np.bool_(True), seed=np.int64(2)).step()


def test_a_wrong_view_is_refused_by_name(near):
    refused(lambda: near().points("Image"), "option", "view")


def test_an_error_passes_between_processes():
    error = bimodal.BimodalError("range", "scale: must be above zero", "scale")
    other = pickle.loads(pickle.dumps(error))
    assert (type(other), other.code, other.field, str(other)) == (bimodal.BimodalError, "range", "scale", str(error))
    assert isinstance(error, ValueError)


def test_messages_speak_pythons_names(near):
    with pytest.raises(bimodal.BimodalError, match="^stop_degrees: "):
        near(stop_degrees=0)


VALUES = [0.0, -1.0, 1e-45, 1e-30, 1e30, 3e38, np.inf, -np.inf, np.nan]


def hostile(rng, shape):
    """Rasters that no camera produces."""
    yield from (np.full(shape, value, np.float32) for value in VALUES)
    yield rng.choice(np.asarray(VALUES, np.float32), shape)
    yield rng.normal(size=shape).astype(np.float32)
    sparse = np.full(shape, np.nan, np.float32)
    sparse.reshape(-1)[:: sparse.size // 20] = 1
    yield sparse


def test_hostile_rasters_are_refused_or_worked_on(rng):
    """No call raises anything but a BimodalError, and no such error reports an abort of the numerics."""
    worked = 0
    plain = np.abs(rng.normal(size=(16, 16, 3)).astype(np.float32)) + 1
    pairs = [(colours, plain[..., 0]) for colours in hostile(rng, (16, 16, 3))]
    pairs += [(plain, depths) for shape in [(16, 16), (16, 16, 3)] for depths in hostile(rng, shape)]
    cameras = [None, bimodal.Pinhole(1e-3, 1e9, -1e9, 1e9), bimodal.Pinhole(16, 16, 8, 8, [9, -9, 9, -9, 9])]
    for (colours, depths), camera in itertools.product(pairs, cameras):
        members = {"data" if depths.ndim == 2 else "points": depths}
        try:
            estimator = bimodal.Estimator(
                bimodal.ColorImage(colours, camera=camera), bimodal.DepthMap(**members, camera=camera), start="identity"
            )
            estimator.run(2)
            worked += 1
        except bimodal.BimodalError as error:
            assert error.code not in ("panic", "poisoned", "type"), error
    assert worked > 5
