"""Files, pictures, matrices and grey images in place of arrays and members: the same numbers give the same bits at the start."""

import types
import warnings

import numpy as np
import pytest
from PIL import Image

import bimodal_stereo as bimodal
from conftest import outcome, refused

K = np.array([[160.0, 0, 15.5], [0, 150.0, 14.5], [0, 0, 1]])
CAMERA = bimodal.Pinhole(160.0, 150.0, 15.5, 14.5)


@pytest.fixture(scope="module")
def levels(scene):
    """The scene's colours as 8-bit levels, and its depth in hundredths of a pixel."""
    colours = np.asarray(scene.image.data)
    eight = (250 * (colours / colours.max()) ** (1 / 2.2)).round().astype(np.uint8)
    return eight, np.nan_to_num(100 * np.asarray(scene.depth.data)).round().astype(np.uint16)


def inside_of(scene):
    """A mask that cannot be derived from the colours; black pixels are left out in any case."""
    inside = np.array(scene.image.mask)
    inside[:, :14] = False
    return inside


@pytest.fixture(scope="module")
def files(levels, scene, tmp_path_factory):
    folder = tmp_path_factory.mktemp("files")
    eight, hundredths = levels
    Image.fromarray(eight).save(folder / "image.png")
    Image.fromarray(eight[..., 1]).save(folder / "grey.png")
    Image.fromarray(hundredths).save(folder / "depth.png")
    Image.fromarray(255 * inside_of(scene).astype(np.uint8)).save(folder / "mask.png")
    np.save(folder / "depth.npy", hundredths.astype(np.float32) / 100)
    return folder


@pytest.fixture
def of_views(scene):
    """All results at the start, with an initial pose near the answer."""

    def run(image, depth):
        own = {"start": "identity", "scale": 1.0, "light": scene.light}
        return outcome(bimodal.Estimator(image, depth, **own))

    return run


def test_files_are_read(files, levels, scene, of_views):
    eight, hundredths = levels
    inside = inside_of(scene)
    expected = of_views(bimodal.ColorImage(eight, mask=inside), bimodal.DepthMap(hundredths, unit=0.01))
    image = bimodal.ColorImage(str(files / "image.png"), mask=files / "mask.png")
    assert of_views(image, bimodal.DepthMap(files / "depth.png", unit=0.01)) == expected
    assert of_views(bimodal.read_image(files / "image.png", mask=inside), bimodal.read_depth(files / "depth.png", unit=0.01)) == expected
    bare = of_views(eight, hundredths)
    assert of_views(files / "image.png", str(files / "depth.png")) == bare != expected
    single = hundredths.astype(np.float32) / 100
    assert of_views(files / "image.png", files / "depth.npy") == of_views(eight, single)


def test_the_unit_of_a_file_with_a_camera_is_guessed_with_a_warning(files, levels, of_views):
    eight, hundredths = levels
    image = bimodal.ColorImage(eight, camera=K)
    with pytest.warns(bimodal.BimodalWarning):
        guessed = of_views(image, bimodal.DepthMap(files / "depth.png", camera=K))
    assert guessed == of_views(image, bimodal.DepthMap(hundredths, camera=K, unit=0.001))
    with pytest.warns(bimodal.BimodalWarning, match="give the unit") as caught:
        depth = bimodal.read_depth(files / "depth.png", camera=K)
    assert caught[0].message.code == "unit-guessed" and depth.unit == 0.001
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert bimodal.read_depth(files / "depth.png", camera=K, unit=0.001).unit == 0.001
        assert bimodal.read_depth(files / "depth.png").unit == 1


def test_a_file_that_cannot_be_read_is_an_error(files):
    for call in (bimodal.read_image, bimodal.read_depth):
        with pytest.raises(bimodal.BimodalError, match="nowhere") as caught:
            call(files / "nowhere.png")
        assert caught.value.code == "file"
    refused(lambda: bimodal.Estimator(files / "image.png", files / "nowhere.png"), "file", "depth.data")
    refused(lambda: bimodal.Estimator(files / "image.png", files / "image.png"), "file", "depth.data")


def test_grey_is_a_colour(files, levels, of_views):
    eight, hundredths = levels
    grey = eight[..., 1]
    expected = of_views(np.dstack([grey] * 3), hundredths)
    assert of_views(grey, hundredths) == of_views(files / "grey.png", hundredths) == expected
    assert of_views(Image.fromarray(grey), hundredths) == expected
    assert of_views(bimodal.ColorImage(grey.astype(np.uint16) * 257, transfer="srgb"), hundredths) == expected


def test_pictures_of_pillow_are_arrays(levels, scene, of_views):
    eight, hundredths = levels
    inside = inside_of(scene)
    image = Image.fromarray(eight)
    expected = of_views(bimodal.ColorImage(eight, mask=inside), hundredths)
    flag = Image.fromarray(255 * inside.astype(np.uint8))
    clear = Image.fromarray(np.dstack([np.full(eight.shape, 255, np.uint8), np.asarray(flag)]))
    for mask in (flag, flag.convert("1"), flag.convert("RGB"), flag.convert("RGBA"), flag.convert("P"), clear):
        assert of_views(bimodal.ColorImage(image, mask=mask), Image.fromarray(hundredths)) == expected
    assert of_views(bimodal.ColorImage(image.convert("RGBA"), mask=inside), hundredths) == expected
    # A palette has its own levels.
    palette = image.convert("P", palette=Image.Palette.ADAPTIVE)
    assert of_views(palette, hundredths) == of_views(np.asarray(palette.convert("RGB")), hundredths)


class OfOpen3D:
    """A stand-in with the interface of Open3D's images and cameras: a buffer, and a matrix."""

    def __init__(self, data):
        self.data, self.intrinsic_matrix = data, data

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self.data, dtype)


OfOpen3D.__module__ = "open3d.cpu.pybind.geometry"


def test_images_and_cameras_of_open3d_are_taken(levels, of_views):
    eight, hundredths = levels
    expected = of_views(bimodal.ColorImage(eight, camera=CAMERA), bimodal.DepthMap(hundredths, camera=CAMERA))
    image = bimodal.ColorImage(OfOpen3D(eight), camera=OfOpen3D(K))
    assert of_views(image, bimodal.DepthMap(OfOpen3D(hundredths), camera=OfOpen3D(K))) == expected


def test_clouds_of_open3d_are_points(levels, tmp_path):
    cloud = OfOpen3D(None)
    cloud.points = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]
    for number, points in enumerate([cloud, cloud.points]):
        bimodal.write_cloud(tmp_path / f"{number}.ply", points)
    assert (tmp_path / "0.ply").read_bytes() == (tmp_path / "1.ply").read_bytes()
    # The cloud has no rows.
    refused(lambda: bimodal.Estimator(levels[0], bimodal.DepthMap(points=cloud)), "size", "depth.points")


def test_cameras_are_matrices(levels, of_views):
    eight, hundredths = levels
    lens = (0.1, -0.02, 0.001, 0, 0)

    def run(camera):
        return of_views(bimodal.ColorImage(eight, camera=camera), bimodal.DepthMap(hundredths, camera=camera))

    expected = run(CAMERA)
    own = {"fx": 160, "fy": 150, "cx": 15.5, "cy": 14.5}
    for camera in (K, K.tolist(), K.astype(np.float32), CAMERA.K, {"K": K}, own, bimodal.Pinhole(**own)):
        assert run(camera) == expected
    distorted = run(bimodal.Pinhole(**own, distortion=lens))
    assert distorted != expected
    assert run({"K": K.tolist(), "distortion": lens}) == run(bimodal.Pinhole(**own, distortion=[*lens, 0, 0, 0])) == distorted
    rational = run(bimodal.Pinhole(**own, distortion=[*lens, 0.1, 0, 0]))
    fisheye = run({"K": K, "distortion": [0.1, 0, 0, 0], "model": "fisheye"})
    assert fisheye == run(bimodal.Pinhole(**own, distortion=[0.1, 0, 0, 0], model="fisheye"))
    assert len({str(each) for each in (expected, distorted, rational, fisheye)}) == 4
    np.testing.assert_array_equal(bimodal.Pinhole(**own).K, K)


def test_poses_are_matrices(near):
    angles = {"alpha": 3, "beta": 10, "gamma": -5}
    start = near(start={"angles": angles, "scale": 1.5, "translation": [1, 2, 3]}, scale="free", registration="fixed").report.pose
    pose = start.matrix
    assert isinstance(pose, np.ndarray) and pose.shape == (4, 4)
    np.testing.assert_allclose(pose[:3, :3], start.scale * start.rotation, rtol=1e-15)
    for form in (pose, pose.tolist(), {"matrix": pose.tolist()}, start, {"rotation": start.rotation.tolist(), "scale": 1.5, "translation": [1, 2, 3]}):
        again = near(start=form, scale="free", registration="fixed").report.pose
        np.testing.assert_allclose(again.matrix, pose, rtol=0, atol=1e-12)


def test_extrinsics_are_matrices(rig):
    frame = bimodal.CheckFrame(rig.image, rig.depth)
    members = {"rotation": rig.pose.rotation, "translation": rig.pose.translation}
    expected = bimodal.project_frame(frame, members)
    for pose in (rig.pose, rig.pose.matrix, rig.pose.matrix.tolist()):
        again = bimodal.project_frame(frame, pose)
        np.testing.assert_allclose(again.points, expected.points, atol=1e-4)
    assert expected.points.shape[1:] == expected.positions.shape[1:] == (3,) and expected.edges.shape[1:] == (2,)
    assert len(expected.points) > 1000 and len(expected.edges) > 10
    # The third coordinate of a point is the depth of its position.
    np.testing.assert_array_equal(expected.points[:, 2], expected.positions[:, 2])
    camera = rig.image.camera.K @ expected.positions.T
    off = np.abs(camera[:2] / camera[2] - expected.points[:, :2].T)
    # The cameras are equal except for the lens.
    assert np.median(off) < 5
    refused(lambda: bimodal.project_frame(frame, 2 * rig.pose.matrix), "range", "pose.matrix")
    refused(lambda: bimodal.check_calibration([frame], {"mine": np.eye(3)}), "size", "candidates.mine")


@pytest.fixture(scope="module")
def rig():
    return bimodal.sample_rig("objects", seed=3)


def test_no_package_is_imported_for_its_objects():
    assert isinstance(bimodal._sources.np, types.ModuleType)
    names = {name for name in vars(bimodal._sources) if isinstance(getattr(bimodal._sources, name), types.ModuleType)}
    assert names == {"os", "warnings", "np", "_native"}
