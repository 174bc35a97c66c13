"""Rendered scenes and rigs, and the check of a calibration on one of them."""

import numpy as np
import pytest

import bimodal_stereo as bimodal
from conftest import refused


def test_names_are_taken():
    assert "bust" in bimodal.sample_surfaces() and "window" in bimodal.sample_lights()


def test_a_sample_has_its_truth(scene):
    inside = np.asarray(scene.image.mask)
    assert inside.dtype == bool and inside.shape == (32, 32)
    assert (np.isfinite(scene.truth.image_depth) == inside).all()
    assert scene.truth.depth_normals.shape == (32, 32, 3) and scene.light.shape == (3, 9)
    np.testing.assert_array_equal(scene.depth.data, scene.truth.depth)
    assert scene.pose.angles.beta == pytest.approx(20)


def test_what_is_asked_for_is_made():
    plain = bimodal.sample("vase", "window", size=32)
    requests = [{"noise": 0.1}, {"depth_noise": 0.5}, {"holes": 0.2}, {"overlap": 0.5}, {"scale": 1.2}, {"angles": {"alpha": 9}}]
    for request in requests:
        other = bimodal.sample("vase", "window", size=32, **request)
        raster = "image" if "noise" in request else "depth"
        before, after = (np.asarray(getattr(made, raster).data) for made in (plain, other))
        assert before.tobytes() != after.tobytes(), request
    noisy = [np.asarray(bimodal.sample("vase", "window", size=32, noise=0.1, seed=seed).image.data) for seed in (1, 2)]
    assert (noisy[0] != noisy[1]).any()
    assert np.asarray(bimodal.sample("bust", "window", size=32, height=24).image.data).shape == (24, 32, 3)
    assert bimodal.sample("bust", plain.light, size=32, angles=bimodal.Angles(gamma=5)).pose.angles.gamma == pytest.approx(5)


def test_heights_of_ones_own_are_a_surface():
    rows, columns = np.mgrid[-1:1:80j, -1:1:64j]
    heights = 30 * np.sqrt(np.clip(1 - (rows / 0.8) ** 2 - columns**2 / 0.3, 0, None))
    made = bimodal.sample(heights, "window", size=32, height=40, angles={"beta": 0})
    inside = np.asarray(made.image.mask)
    # Taller than wide, as the heights are.
    assert inside.any(axis=1).sum() > inside.any(axis=0).sum() > 4


def test_a_grid_is_a_cloud():
    made = bimodal.sample("bust", "window", protocol="grid", angles={"beta": 10})
    assert made.depth.data is None and made.depth.points.shape == made.depth.normals.shape
    refused(lambda: bimodal.sample("bust", "window", protocol="grid", noise=0.1), "option", "noise")


def test_bad_requests_are_refused_by_name():
    bad = [
        (("ghost", "window"), {}, "range", "surface"),
        (("bust", "candle"), {}, "range", "light"),
        (("bust", [1, 2]), {}, "size", "light"),
        ((np.zeros((3, 3)), "window"), {}, "size", "surface"),
        ((np.zeros(3), "window"), {}, "type", "surface"),
        (("bust", "window"), {"size": 4}, "size", "size"),
        (("bust", "window"), {"size": -4}, "range", "size"),
        (("bust", "window"), {"noise": float("nan")}, "range", "noise"),
        (("bust", "window"), {"depth_noise": -1}, "range", "depth_noise"),
        (("bust", "window"), {"holes": 1}, "range", "holes"),
        (("bust", "window"), {"angles": {"beta": 361}}, "range", "angles.beta"),
        (("bust", "window"), {"angles": {"delta": 3}}, "option", "angles.delta"),
        (("bust", "window"), {"protocol": "photo"}, "option", "protocol"),
    ]
    for arguments, request, code, field in bad:
        refused(lambda: bimodal.sample(*arguments, **request), code, field)


@pytest.fixture(scope="module")
def rig():
    return bimodal.sample_rig("room", seed=1)


def test_a_check_agrees_with_the_truth_and_not_with_an_error(rig):
    shifted = {"rotation": rig.pose.rotation, "translation": rig.pose.translation + [0.05, 0, 0]}
    seen = []
    check = bimodal.check_calibration(
        [bimodal.CheckFrame(rig.image, rig.depth)],
        {"shifted": shifted, "true": rig.pose},
        on_progress=lambda share, message: seen.append((share, message)),
    )
    assert (check.verdict, list(check.candidates)) == ("off", ["shifted", "true"])
    assert check.reason == check.candidates["shifted"].reason
    assert check.candidates["true"].verdict == "consistent"
    assert check.candidates["shifted"].off_millimetres == pytest.approx(50, abs=10)
    assert check.tolerance == 3.5
    assert seen[-1] == (1.0, "done") and all(message for _, message in seen)
    assert check.covariance.shape == (6, 6) and (np.linalg.eigvalsh(check.covariance) > 0).all()
    assert sum(cue.share for cue in check.cues.values()) == pytest.approx(1)
    assert [frame.name for frame in check.frames] == ["frame 1"] and check.focal is None
    assert check.sensitivity[0].offsets.shape == check.sensitivity[0].values.shape
    assert 0 < check.next.expected < check.next.sigma and check.next.frame == "frame 1"
    moved = bimodal.sample_rig("room", seed=1, motion=check.next.pose)
    assert (moved.depth.data != rig.depth.data).any() and (moved.pose.rotation == rig.pose.rotation).all()


def test_what_on_progress_raises_ends_a_check(rig):
    def stop(share, message):
        raise LookupError(message)

    with pytest.raises(LookupError):
        bimodal.check_calibration([rig], {"true": rig.pose}, on_progress=stop)


def test_bad_checks_are_refused_by_name(rig):
    frame = bimodal.CheckFrame(rig.image, rig.depth)

    def check(frames=(frame,), candidates={"factory": rig.pose}, **options):
        return lambda: bimodal.check_calibration(list(frames), candidates, **options)

    def with_depth(**members):
        return bimodal.CheckFrame(rig.image, bimodal.DepthMap(**{**vars(rig.depth), **members}))

    def with_camera(**members):
        return with_depth(camera=bimodal.Pinhole(**{**vars(rig.depth.camera), **members}))

    refused(check(frames=[]), "size", "frames")
    refused(check(frames=[rig.image]), "type", "frames[0]")
    refused(check(frames=[frame, with_depth(data=rig.depth.data[:, :0])]), "size", "frames[1].depth")
    refused(check(frames=[with_depth(camera=None)]), "missing", "frames[0].depth.camera")
    refused(check(frames=[with_depth(normals=np.zeros((*rig.depth.data.shape, 3)))]), "option", "frames[0].depth.normals")
    refused(check(frames=[with_camera(fx=-1)]), "range", "frames[0].depth.camera.fx")
    refused(check(frames=[with_camera(model="round")]), "option", "frames[0].depth.camera.model")
    refused(check(frames=[with_camera(distortion=[1, 2, 3])]), "size", "frames[0].depth.camera.distortion")
    refused(check(frames=[with_camera(model="fisheye", distortion=[1])]), "size", "frames[0].depth.camera.distortion")
    refused(check(candidates=[rig.pose]), "type", "candidates")
    refused(check(candidates={"aRig": {"rotation": np.eye(3)}}), "missing", "candidates.aRig.translation")
    refused(check(candidates={"aRig": {"rotation": 2 * np.eye(3), "translation": [0, 0, 0]}}), "range", "candidates.aRig.rotation")
    refused(check(candidates={"aRig": {**vars(rig.pose), "scale": 2}}), "range", "candidates.aRig.scale")
    refused(check(cues=["smell"]), "option", "cues")
    refused(check(cues=[]), "size", "cues")
    refused(check(cues="edges"), "type", "cues")
    refused(lambda: bimodal.sample_rig("attic"), "option", "kind")
    refused(lambda: bimodal.sample_rig("boxes", seed=-1), "range", "seed")
    refused(lambda: bimodal.sample_rig("boxes", noise=float("inf")), "range", "noise")
    refused(lambda: bimodal.sample_rig("boxes", motion=2 * np.eye(3)), "size", "motion")


def test_a_scene_has_a_bound():
    known = bimodal.sample_bound("bust", "colourful", light_is_known=True, size=32, noise=0.01)
    unknown = bimodal.sample_bound("bust", "colourful", light_is_known=False, size=32, noise=0.01)
    assert 0 < known <= unknown < 10
    assert bimodal.sample_bound("bust", "colourful", light_is_known=True, size=32) is None
    refused(lambda: bimodal.sample_bound("bust", "candle", light_is_known=True), "range", "light")
