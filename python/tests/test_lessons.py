"""Single parts of the method: values that can be computed in another way."""

import numpy as np

import bimodal_stereo as bimodal
from conftest import refused


def test_normals_of_a_slope_become_its_depth():
    rows, columns = np.indices((12, 16))
    depth = 0.5 * columns - 0.25 * rows
    normal = np.array([0.5, -0.25, -1]) / np.linalg.norm([0.5, -0.25, -1])
    normals = np.broadcast_to(normal, (12, 16, 3)).copy()
    for robust in (True, False):
        found = bimodal.integrate_normals(normals, robust=robust)
        assert (found.shape, found.dtype) == ((12, 16), np.float32)
        np.testing.assert_allclose(found, depth - depth.mean(), atol=1e-3)
    normals[0, 0] = np.nan
    assert np.isnan(bimodal.integrate_normals(normals)[0, 0])
    refused(lambda: bimodal.integrate_normals(normals[0]), "size", "normals")
    refused(lambda: bimodal.integrate_normals(np.full((8, 8, 3), np.nan)), "empty", "mask")


def test_a_turned_light_shades_turned_normals(rng):
    angles = {"alpha": 20, "beta": -30, "gamma": 65}
    turned = bimodal.turn_light("window", angles)
    assert (turned.shape, turned.dtype) == ((3, 9), np.float64)
    scene = bimodal.sample("bust", "window", size=32, angles=angles)
    np.testing.assert_allclose(bimodal.turn_light("window", scene.pose.angles), turned, atol=1e-12)
    normals = rng.normal(size=(5, 7, 3))
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    before = bimodal.shade_normals("window", normals)
    assert (before.shape, before.dtype) == ((5, 7, 3), np.float32)
    np.testing.assert_allclose(bimodal.shade_normals(turned, normals @ scene.pose.rotation.T), before, atol=1e-5)
    same = bimodal.turn_light(scene.light)
    np.testing.assert_array_equal(same, scene.light)
    refused(lambda: bimodal.turn_light("candle"), "range", "light")
    refused(lambda: bimodal.turn_light("window", {"beta": 400}), "range", "angles.beta")
    refused(lambda: bimodal.shade_normals("window", [1, 2]), "size", "normals")


def test_the_lowest_minimum_of_a_pixel_is_the_normal_that_shaded_it():
    normal = np.array([0.3, -0.2, -np.sqrt(1 - 0.13)])
    log = bimodal.shade_normals("colourful", normal)
    found = bimodal.pixel_landscape(log, "colourful", side=33)
    assert found.objective.shape == (33, 33) and found.minima.shape[1:] == (5,) and found.path.shape[1:] == (3,)
    assert np.isnan(found.objective[0, 0]) and (np.diff(found.minima[:, 3]) >= 0).all()
    np.testing.assert_allclose(found.minima[0, :3], normal, atol=1e-2)
    np.testing.assert_allclose(found.path[0], [0, 0, -1], atol=1e-6)
    # A heavy prior determines the answer.
    drawn = bimodal.pixel_landscape(log, "colourful", prior=[0, 0, -1], weight=1e4, robust=False, start=normal, side=0)
    assert drawn.objective.shape == (0, 0)
    np.testing.assert_allclose(drawn.minima[0, :3], [0, 0, -1], atol=1e-2)
    np.testing.assert_allclose(drawn.path[0], normal, atol=1e-6)


def test_requests_for_a_landscape_are_checked():
    log = [-1, -1, -1]
    refused(lambda: bimodal.pixel_landscape(log[:2], "window"), "size", "log")
    refused(lambda: bimodal.pixel_landscape([0, np.nan, 0], "window"), "range", "log")
    refused(lambda: bimodal.pixel_landscape(log, "window", side=513), "range", "side")
    refused(lambda: bimodal.pixel_landscape(log, "window", side=0.5), "type", "side")
    refused(lambda: bimodal.pixel_landscape(log, "window", weight=-1), "range", "weight")
    refused(lambda: bimodal.pixel_landscape(log, [0] * 26), "size", "light")
    refused(lambda: bimodal.pixel_landscape(log, "window", prior=[1e9, 0, 0]), "range", "prior")


def test_bas_relief_keeps_the_intensity_under_its_own_lamp(rng):
    normals = rng.normal(size=(6, 5, 3))
    normals[..., 2] = -np.abs(normals[..., 2]) - 1
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    lamp = [0.3, -0.2, -0.9]
    np.testing.assert_allclose(bimodal.shade_lamp(lamp, normals), np.maximum(normals @ lamp, 0), atol=1e-6)
    other = bimodal.bas_relief(normals, lamp, 0.5, right=0.2, down=-0.1)
    assert (other.normals.shape, other.albedo.shape) == ((6, 5, 3), (6, 5))
    np.testing.assert_allclose(other.albedo * (other.normals @ other.lamp), normals @ lamp, atol=1e-6)
    refused(lambda: bimodal.bas_relief(normals, lamp, 0), "range", "stretch")
    refused(lambda: bimodal.shade_lamp([1, 2], normals), "size", "lamp")


def test_strips_of_a_ball_lie_on_it():
    radius, middle = 40.0, 47.5
    rows, columns = np.indices((96, 96)) - middle
    inside = columns**2 + rows**2 < (radius - 1) ** 2
    height = np.sqrt(np.where(inside, radius**2 - columns**2 - rows**2, 1))
    # Under a lamp at the camera the intensity is -n_z.
    intensity = np.where(inside, height / radius, np.nan)
    strips = bimodal.characteristic_strips(intensity, [0, 0, -1], [48, 48], count=8)
    assert len(strips) == 8 and all(strip.shape[1] == 3 for strip in strips)
    for strip in strips:
        column, row, depth = strip[len(strip) // 2]
        expected = radius - np.sqrt(radius**2 - (column - middle) ** 2 - (row - middle) ** 2)
        assert abs(depth - expected) < 1
    refused(lambda: bimodal.characteristic_strips(intensity, [0, 0, -1], [1000, 48]), "range", "centre")


def test_harmonics_of_second_order_are_their_own_approximation():
    along = (np.arange(200) + 0.5) / 100 - 1
    polynomial = 0.2 + 0.5 * along - 0.3 * along**2
    np.testing.assert_allclose(bimodal.second_order(polynomial), polynomial, atol=1e-3)
