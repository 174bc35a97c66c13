"""The widgets' side in the kernel; tests/notebooks has the browser's."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import bimodal_stereo as bimodal

widget = pytest.importorskip("bimodal_stereo.widget", reason="needs anywidget: pip install anywidget", exc_type=ImportError)


@pytest.fixture
def lab(scene):
    return widget.Lab(scene.image, scene.depth, start="identity", stop_degrees=0.02, lambda_={"prior": 0.1}, light=scene.light)


def test_a_pair_is_sent_as_bytes(lab, scene):
    image, depth = lab._pair["image"], lab._pair["depth"]
    assert (image["width"], image["height"], image["data"]["type"]) == (32, 32, "float32")
    assert np.array_equal(np.frombuffer(image["data"]["bytes"], np.float32).reshape(32, 32, 3), scene.image.data)
    assert np.array_equal(np.frombuffer(depth["mask"]["bytes"], np.uint8).reshape(32, 32) != 0, scene.depth.mask)
    assert "camera" not in image and "unit" not in depth


def test_cameras_and_poses_are_sent_by_their_names():
    K = [[50.0, 0, 15.5], [0, 50, 15.5], [0, 0, 1]]
    flat = np.full((32, 32), 700, np.uint16)
    made = widget.Lab(np.full((32, 32, 3), 9, np.uint8), bimodal.DepthMap(flat, camera=K, unit=0.001), start=np.eye(4))
    assert made._pair["depth"]["camera"] == {"fx": 50, "fy": 50, "cx": 15.5, "cy": 15.5}
    assert (made._pair["depth"]["unit"], made._pair["depth"]["data"]["type"]) == (0.001, "uint16")
    assert made._options == {"start": {"matrix": np.eye(4).tolist()}}


def test_options_have_their_javascript_names(lab, scene):
    assert lab._options["stopDegrees"] == 0.02 and lab._options["lambda"] == {"prior": 0.1}
    assert lab._options["light"] == scene.light.ravel().tolist()


def test_a_report_is_that_of_the_package(lab, near):
    assert lab.report is None
    raw = near()._own.report()
    lab._report = {**raw, "residual": None}
    assert isinstance(lab.report, bimodal.StepReport) and np.isnan(lab.report.residual)
    assert np.array_equal(lab.report.pose.rotation, near().report.pose.rotation)


def test_a_browser_receives_its_files_when_it_asks(lab):
    sent = []
    lab.send = lambda content, buffers: sent.append((content, buffers))
    lab._answer(lab, {"wants": "anything"}, [])
    lab._answer(lab, {"wants": "files"}, [])
    [(content, buffers)] = sent
    assert content == {"files": ["stereo-thread", "figure-thread", "wasm"]}
    assert [len(each) > 50_000 for each in buffers] == [True] * 3 and buffers[2][:2] == b"\x1f\x8b"


def test_a_figure_has_the_state_of_its_element():
    figure = widget.Figure("pixel", state="noise=2")
    assert (figure.lesson, figure.state, figure.result, figure.error) == ("pixel", "noise=2", {}, {})


def test_the_files_are_required(monkeypatch):
    monkeypatch.setattr(widget, "files", lambda _: Path("/nowhere"))
    widget.content.cache_clear()
    with pytest.raises(bimodal.BimodalError) as caught:
        widget.Figure("pixel")
    assert (caught.value.code, caught.value.field) == ("missing", "widget")
    widget.content.cache_clear()


WITHOUT = """import sys
sys.modules["anywidget"] = None
import bimodal_stereo
try:
    bimodal_stereo.widget
except ImportError as error:
    print(error)
"""


def test_the_package_itself_does_not_need_anywidget():
    done = subprocess.run([sys.executable, "-c", WITHOUT], check=True, capture_output=True, text=True)
    assert done.stdout == "bimodal_stereo.widget needs anywidget: pip install anywidget\n"
    with pytest.raises(AttributeError):
        bimodal.no_such_name
