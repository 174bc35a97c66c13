"""A run saved as bytes continues to the same bits, and anything else is refused by name."""

import json
import shutil
import struct
import subprocess
from pathlib import Path
from zlib import crc32

import numpy as np
import pytest

import bimodal_stereo as bimodal
from conftest import outcome

ROOT = Path(__file__).parents[2]
PKG = ROOT / "pkg" / "index.js"
NODE = shutil.which("node")
# Offsets of the header's length and of the header.
MARK, HEADER = 16, 20


def after(estimator, *calls):
    for call in calls:
        getattr(estimator, call)()
    return estimator


CASES = {
    "before the first step": ({}, ()),
    "after iterations": ({}, ("step", "step")),
    "within an iteration": ({}, ("step", "step_stage", "step_stage")),
    "after a first stage": ({}, ("step_stage",)),
    "at the end": ({"max_iterations": 2}, ("step", "step")),
    "with the paper's registration": ({"registration": "icp", "shading": "pixel"}, ("step",)),
    "within a search": ({"start": "search", "light": "estimate", "scale": "free", "max_iterations": 1}, ("step", "step", "step")),
    "after a reset": ({}, ("step", "reset", "step")),
}


@pytest.mark.parametrize("options, calls", CASES.values(), ids=CASES.keys())
def test_a_restored_run_ends_with_the_same_bits(near, options, calls):
    run = after(near(**{"max_iterations": 4, **options}), *calls)
    other = bimodal.Estimator.restore(run.save())
    assert outcome(other) == outcome(run)
    run.run()
    other.run()
    assert outcome(other) == outcome(run)
    assert other.save() == run.save()


def test_with_all_that_views_and_options_may_have(scene):
    camera = bimodal.Pinhole(np.float64(90), 90, 15.5, 15.5)
    mask = np.asarray(scene.image.mask)
    colours = (65535 * np.minimum(1, np.nan_to_num(scene.image.data))).astype(np.uint16)
    image = bimodal.ColorImage(colours, mask, camera, "linear")
    metres = (40 + np.asarray(scene.depth.data)) / 400
    lens = bimodal.Pinhole(90, 90, 15.5, 15.5, [0.01, 0, 0, 0, 0])
    depth = bimodal.DepthMap(metres, mask=scene.depth.mask, camera=lens, unit=1.5)
    rotation = bimodal.sample("bust", "window", size=32, angles={"beta": 15}).pose.rotation
    told = {"start": {"rotation": rotation}, "start_tolerance": {"degrees": np.float32(20)}, "lambda_": {"prior": 2}}
    run = bimodal.Estimator(image, depth, light=scene.light, max_iterations=np.int64(2), **told)
    run.step()
    other = bimodal.Estimator.restore(run.save())
    assert outcome(other) == outcome(run)
    run.run()
    other.run()
    assert outcome(other) == outcome(run)


def test_organised_clouds_with_normals():
    scene = bimodal.sample("vase", "overcast", protocol="grid", angles={"beta": 10})
    run = bimodal.Estimator(scene.image, scene.depth, start="identity", registration="icp", shading="pixel")
    run.run(2)
    assert outcome(bimodal.Estimator.restore(memoryview(run.save()))) == outcome(run)


def test_whatever_becomes_of_the_arrays_that_it_was_given(scene, near):
    colours, depths = np.array(scene.image.data), np.array(scene.depth.data)
    light = np.array(scene.light)
    run = near(
        bimodal.ColorImage(colours, scene.image.mask), bimodal.DepthMap(depths, mask=scene.depth.mask), light=light, max_iterations=2
    )
    state = run.save()
    colours[:], depths[:], light[:] = 1, np.nan, 0
    assert run.save() == state
    run.step()
    assert outcome(bimodal.Estimator.restore(run.save())) == outcome(run)


def test_the_options_of_a_reset_are_those_that_are_saved(near):
    run = near()
    run.run(2)
    run.reset(start="identity", scale=1.0, registration="icp", shading="pixel", max_iterations=3)
    run.run(1)
    other = bimodal.Estimator.restore(run.save())
    other.run()
    run.run()
    assert run.report.iteration == 3 and outcome(other) == outcome(run)


@pytest.fixture(scope="module")
def state(scene):
    run = bimodal.Estimator(scene.image, scene.depth, start="identity", scale=1.0, light=scene.light, max_iterations=2)
    run.step()
    return run.save()


def bad(state, words, code="state"):
    with pytest.raises(bimodal.BimodalError, match=words) as caught:
        bimodal.Estimator.restore(state)
    assert (caught.value.code, caught.value.field) == (code, "state")


def checked(whole):
    """The bytes with a valid checksum."""
    return whole + struct.pack("<I", crc32(whole))


def changed(state, change):
    """The same state with another header."""
    length = struct.unpack_from("<I", state, MARK)[0]
    header = json.loads(state[HEADER : HEADER + length])
    other = change(header)
    text = json.dumps(header if other is None else other).encode()
    return checked(state[:MARK] + struct.pack("<I", len(text)) + text + state[HEADER + length : -4])


def test_what_is_no_state_is_refused():
    for value in (None, "state", [1, 2], np.zeros(8, np.uint8)):
        bad(value, "must be bytes", "type")
    for value in (b"", b"\1\2\3", b"\x89PNG\r\n\x1a\n and so on", bytes(1000)):
        bad(value, "not a saved run")


def test_one_that_is_cut_off_is_refused_anywhere(state):
    length = 15
    while length < len(state):
        bad(state[:length], "cut off")
        length += 1 + (length >> 3)


def test_one_with_a_wrong_byte_is_refused_anywhere(state):
    at = 16
    while at < len(state):
        bad(state[:at] + bytes([state[at] ^ 16]) + state[at + 1 :], "damaged")
        at += 1 + (at >> 3)


def test_another_format_is_refused(state):
    bad(state[:15] + b"\x82" + state[16:], "format 130; this version reads format 129")


def put(*path):
    """A change that sets the member at a path to a value; the value comes last."""
    *names, last, value = path

    def change(header):
        inner = header
        for name in names:
            inner = inner[name]
        inner[last] = value

    return change


@pytest.mark.parametrize(
    "change, words",
    [
        (put("options", "lamda", {}), "lamda"),
        (put("options", "seed", -1), "seed"),
        (put("options", []), "header.options"),
        (put("image", "width", 31), "image"),
        (put("depth", "camera", 5), "depth.camera"),
        (put("arrays", 0, "type", "float64"), "no such array"),
        (put("arrays", 0, "member", "__class__"), "no such array"),
        (put("arrays", 0, "view", 1), "arrays.0..view"),
        (put("arrays", 0, "length", 2**40), "cut off"),
        (put("arrays", 0, "length", -1), "length"),
        (put("arrays", 0, "length", True), "length"),
        (lambda header: header["arrays"].pop() and None, "longer than it declares"),
        (put("arrays", {"length": 3}), "header.arrays"),
        (put("arrays", [3]), "header.arrays.0"),
        (put("reached", "iteration", -1), "iteration"),
        (put("reached", "begun", 1), "begun"),
        (put("reached", "stage", "end"), "stage"),
        (put("more", 1), "nothing else"),
        (lambda _: [1], "header"),
        (lambda _: 5, "header"),
        # A run with other results, and ends that are never reached.
        (lambda header: put("found", header["found"] ^ 1)(header), "different digits"),
        (put("reached", "iteration", 10**9), "different digits"),
        (put("reached", "slices", 10**9), "different digits"),
    ],
)
def test_a_header_that_says_something_else_is_refused_though_its_checksum_is_right(state, change, words):
    bad(changed(state, change), words)


def test_a_header_that_is_no_header_is_refused(state):
    for text in (b"[" * 60_000, b"\xff\xfe", b"{"):
        bad(checked(state[:MARK] + struct.pack("<I", len(text)) + text), "cannot be read")
    bad(checked(state[:MARK] + struct.pack("<I", 2**31)), "too long")


def by_node(script, folder):
    prelude = f"""import {{ readFileSync, writeFileSync }} from "node:fs";
        import init, {{ Estimator, sample }} from {json.dumps(PKG.as_uri())};
        await init();"""
    found = subprocess.run([NODE, "--input-type=module", "-e", prelude + script], cwd=folder, check=True, capture_output=True)
    return found.stdout.decode()


@pytest.mark.skipif(NODE is None or not PKG.exists(), reason="needs Node and the package in pkg/ (npm run build)")
def test_neither_package_takes_what_the_other_has_saved(state, tmp_path):
    """Their last digits differ, so neither package could guarantee the same bits."""
    (tmp_path / "python").write_bytes(state)
    script = """
        const { image, depth } = sample({ surface: "bust", light: "window", size: 32 });
        writeFileSync("javascript", new Estimator(image, depth).save());
        try { Estimator.restore(new Uint8Array(readFileSync("python"))); } catch ({ code, message }) { console.log(code, message); }
    """
    assert "state state: has format 129; this version reads format 1" in by_node(script, tmp_path)
    bad((tmp_path / "javascript").read_bytes(), "saved by the JavaScript package .format 1.*run the pair again")
