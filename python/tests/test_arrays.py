"""Reading of arrays: equal numbers in another type, order or wrapping give the same bits at the start, other numbers do
not."""

import numpy as np
import pytest

import bimodal_stereo as bimodal
from conftest import outcome

CAMERA = bimodal.Pinhole(160, 160, 15.5, 15.5)


@pytest.fixture(scope="module")
def levels(scene):
    """The scene's colours as 8-bit levels and its depth as 16-bit levels, each with 0 outside."""
    colours = np.asarray(scene.image.data)
    eight = (250 * (colours / colours.max()) ** (1 / 2.2)).round().astype(np.uint8)
    return eight, np.nan_to_num(100 * np.asarray(scene.depth.data)).round().astype(np.uint16)


def image(data, scene, **members):
    return bimodal.ColorImage(data, **{"mask": scene.image.mask, **members})


def with_alpha(data, alpha):
    return np.concatenate([data, np.full((*data.shape[:2], 1), alpha, data.dtype)], axis=2)


def test_colours_of_another_form_are_the_same(scene, near, levels):
    eight, _ = levels
    expected = outcome(near(image(eight, scene)))
    inverted = np.ascontiguousarray(eight[..., ::-1])[..., ::-1]
    wide = np.repeat(eight, 2, axis=1)[:, ::2]
    forms = [with_alpha(eight, 255), with_alpha(eight, 9), np.asfortranarray(eight), inverted, wide]
    assert all(outcome(near(image(form, scene))) == expected for form in forms)
    assert outcome(near(image(eight, scene, transfer="srgb"))) == expected
    assert outcome(near(image(eight, scene, transfer="linear"))) != expected


def test_sixteen_bits_are_guessed_and_told(scene, near, levels):
    wide = levels[0].astype(np.uint16) * 257
    expected = outcome(near(image(wide, scene)))
    assert outcome(near(image(wide.astype(">u2"), scene))) == expected
    assert outcome(near(image(wide, scene, transfer="srgb"))) == expected
    assert outcome(near(image(wide, scene, transfer="linear"))) != expected
    # Levels between those of 8 bits come from a sensor.
    fine = np.where(wide > 0, wide + 1, 0).astype(np.uint16)
    assert outcome(near(image(fine, scene))) == outcome(near(image(fine, scene, transfer="linear")))


def test_floats_are_linear(scene, near):
    single = np.asarray(scene.image.data)
    expected = outcome(near(image(single, scene)))
    assert outcome(near(image(single.astype(np.float64), scene))) == expected
    assert outcome(near(image(single.astype(">f4"), scene))) == expected
    beside = np.frombuffer(b"\0" + single.tobytes(), np.float32, offset=1).reshape(single.shape)
    assert not beside.flags.aligned and outcome(near(image(beside, scene))) == expected
    assert outcome(near(image(with_alpha(single, 1), scene))) == expected


def test_srgb_is_decoded_by_the_standard(scene, near, levels):
    eight = levels[0] / 255
    linear = np.where(eight <= 0.04045, eight / 12.92, ((eight + 0.055) / 1.055) ** 2.4).astype(np.float32)
    usable = ((levels[0] > 3) & (levels[0] < 255)).all(axis=2)
    decoded = near(image(linear, scene, mask=usable & scene.image.mask))
    encoded = near(image(levels[0], scene))
    np.testing.assert_allclose(decoded.residual(), encoded.residual(), atol=1e-5)


def test_transparent_pixels_are_left_out(scene, near, levels):
    for colours in (levels[0], np.asarray(scene.image.data)):
        clear = with_alpha(colours, np.asarray(1, colours.dtype))
        clear[:, :16, 3] = 0
        masked = np.array(scene.image.mask)
        masked[:, :16] = False
        opaque = colours if colours.dtype.kind == "f" else with_alpha(colours, 1)
        assert outcome(near(image(clear, scene))) == outcome(near(image(opaque, scene, mask=masked)))


def test_masks_are_whatever_is_not_zero(scene, near):
    inside = np.array(scene.image.mask)
    expected = outcome(near())
    for form in (inside.astype(np.uint8), 255 * inside.astype(np.uint8), 0.5 * inside, 256 * inside.astype(np.int64)):
        assert outcome(near(image(scene.image.data, scene, mask=form))) == expected


def test_bare_arrays_are_views(scene, near):
    image, depth = np.array(scene.image.data), np.array(scene.depth.data)
    own = near(bimodal.ColorImage(image), bimodal.DepthMap(depth))
    assert outcome(near(image, depth)) == outcome(own)


def test_depths_of_another_form_are_the_same(scene, near, levels):
    _, hundredths = levels

    def outcome_with(data, **members):
        return outcome(near(depth=bimodal.DepthMap(data, mask=scene.depth.mask, **{"unit": 0.01, **members})))

    expected = outcome_with(hundredths)
    for kind in (np.int32, np.int64, np.uint32, ">u2"):
        assert outcome_with(hundredths.astype(kind)) == expected
    assert outcome_with(np.asfortranarray(hundredths)) == expected
    assert outcome_with(hundredths, unit=0.011) != expected
    single = np.asarray(scene.depth.data)
    assert outcome_with(single, unit=None) == outcome_with(single.astype(np.float64), unit=1) == outcome(near())


def test_units_default_to_millimetres_for_integers_with_a_camera(levels):
    millimetres = levels[1]
    colours = np.full((*millimetres.shape, 3), 100, np.uint8)

    def depth_of(data, **members):
        depth = bimodal.DepthMap(data, mask=millimetres > 0, **members)
        image = bimodal.ColorImage(colours, mask=millimetres > 0, camera=members.get("camera"))
        return bimodal.Estimator(image, depth, start="identity").refined_depth()

    told = depth_of(millimetres, camera=CAMERA, unit=0.001)
    assert np.nanmax(told) < 10
    assert depth_of(millimetres, camera=CAMERA).tobytes() == told.tobytes()
    metres = depth_of(millimetres.astype(np.float32), camera=CAMERA)
    np.testing.assert_allclose(metres, 1000 * told, rtol=1e-5)
    assert np.nanmax(depth_of(millimetres)) > 1000


def test_clouds_are_points_row_by_row(scene, near):
    depth = np.asarray(scene.depth.data)
    rows, columns = np.indices(depth.shape)
    # Without a camera, x and y are counted from the raster's middle.
    points = np.dstack([columns - 15.5, rows - 15.5, depth]).astype(np.float32)
    points[np.isnan(depth)] = np.nan
    cloud = near(depth=bimodal.DepthMap(points=points, mask=scene.depth.mask))
    inside = np.isfinite(depth)
    # The depths agree up to the noise, which is removed from maps.
    np.testing.assert_allclose(cloud.refined_depth()[inside], depth[inside], atol=0.1)
    np.testing.assert_allclose(cloud.points("depth")[:, :2], near().points("depth")[:, :2], atol=0.1)
    wide = points.astype(np.float64)
    assert outcome(near(depth=points)) == outcome(near(depth=wide)) == outcome(near(depth=bimodal.DepthMap(points=points)))


def test_normals_override_our_own(scene, near):
    normals = np.array(scene.truth.depth_normals)
    told = bimodal.DepthMap(scene.depth.data, mask=scene.depth.mask, normals=normals)
    assert outcome(near(depth=told)) != outcome(near())
    half = np.dstack([normals[..., :2], normals[..., 2]]).astype(np.float64)
    wide = bimodal.DepthMap(scene.depth.data, mask=scene.depth.mask, normals=half)
    assert outcome(near(depth=wide)) == outcome(near(depth=told))


def test_arrays_come_out_in_their_shapes(near):
    wide = bimodal.sample("bust", "window", size=40, height=24)
    estimator = bimodal.Estimator(wide.image, wide.depth, start="identity")
    estimator.step()
    for name in ("image_normals", "depth_normals", "albedo", "shading"):
        made = getattr(estimator, name)()
        assert (made.shape, made.dtype) == ((24, 40, 3), np.float32), name
    for name in ("image_depth", "refined_depth", "residual"):
        made = getattr(estimator, name)()
        assert (made.shape, made.dtype) == ((24, 40), np.float32), name
    assert (estimator.correspondence().shape, estimator.correspondence().dtype) == ((24, 40), np.int32)
    assert (estimator.light().shape, estimator.light().dtype) == ((3, 9), np.float64)
    for view in ("image", "depth"):
        points = estimator.points(view)
        assert points.shape[1:] == (3,) and len(points) > 100
    inside = np.asarray(wide.image.mask)
    normals = estimator.image_normals()
    assert np.isnan(normals[~inside]).all()
    np.testing.assert_allclose(np.linalg.norm(normals[inside], axis=1), 1, atol=1e-3)
    # Rows are not swapped with columns: the surface lies where the object is, not where its transpose would.
    assert (np.isfinite(estimator.image_depth()) == inside).all()


def test_arrays_that_come_out_are_copies(near):
    estimator = near()
    estimator.step()
    first = estimator.refined_depth()
    before = first.tobytes()
    estimator.step()
    assert first.tobytes() == before
    first[:] = 0
    assert estimator.refined_depth().tobytes() != first.tobytes()


def test_arrays_that_went_in_may_change(scene, near):
    data = np.array(scene.image.data)
    estimator = near(image(data, scene))
    data[:] = 0
    assert outcome(estimator) == outcome(near())


def test_correspondences_are_indices_of_depth_pixels(scene, near):
    estimator = near()
    estimator.run()
    found = estimator.correspondence()
    rows, columns = np.unravel_index(found[found >= 0], scene.depth.data.shape)
    assert found.min() == -1 and np.asarray(scene.depth.mask)[rows, columns].all()
