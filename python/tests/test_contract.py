"""The names and ranges of the JavaScript package, in Python's spelling."""

import ast
import inspect
import json
import re
import shutil
import subprocess
from dataclasses import fields
from pathlib import Path

import pytest

import bimodal_stereo as bimodal

ROOT = Path(__file__).parents[2]
NODE = shutil.which("node")

# Names without an equivalent here, each with the reason.
LEFT_OUT = {
    "width": "arrays have a shape",
    "height": "likewise",
    "draw": "paints on a canvas",
    "stepFor": "keeps a page alive",
    "searchScores": "the page's picture of the search",
    "registeredBy": "no part of the contract",
    "warnings": "threads are the system's own",
    "ErrorDetails": "arguments of an error's own constructor",
    "ErrorCode": "a text here",
    "Given": "of given",
    "wasmUrl": "there is no .wasm file",
    "given": "what a restored run was made of",
    "free": "memory is given back by itself",
}


def spelled(name):
    return {"lambda": "lambda_"}.get(name, re.sub("[A-Z]", lambda letter: f"_{letter[0].lower()}", name))


TYPES = "\n".join(path.read_text() for path in sorted((ROOT / "js/types").glob("*.ts")))


def members(interface):
    """The members of an interface in js/types/."""
    body = re.search(rf"export interface {interface}\b[^{{]*{{\n(.*?)\n}}", TYPES, re.DOTALL)
    return re.findall(r"^  (\w+)\??:", body[1], re.MULTILINE)


def kept(names):
    return {spelled(name) for name in names if name not in LEFT_OUT}


@pytest.mark.parametrize("name", ["Pinhole", "ColorImage", "DepthMap", "Pose", "Uncertainty", "StepReport", "Sample", "CandidateReport"])
def test_objects_have_the_same_members(name):
    interface = members(name)
    assert len(interface) > 3
    assert {field.name for field in fields(getattr(bimodal, name))} == kept(interface)


@pytest.mark.parametrize("name", ["FrameOverlay", "PixelLandscape"])
def test_small_objects_have_the_same_members(name):
    assert {field.name for field in fields(getattr(bimodal, name))} == kept(members(name)) != set()


def test_the_package_has_the_same_functions():
    exported = re.findall(r"^export {(.*?)}", (ROOT / "js/index.ts").read_text(), re.MULTILINE | re.DOTALL)
    names = {name for names in exported for name in re.findall(r"\b(?<!type )[A-Za-z]\w*", names)} - {"type"}
    assert {"sampleRig", "integrateNormals", "Estimator"} <= names
    own = {spelled(name) if name[0].islower() else name for name in names if name not in LEFT_OUT}
    assert own <= set(bimodal.__all__)


def test_what_is_exported_is_there_and_in_order():
    assert all(hasattr(bimodal, name) for name in bimodal.__all__) and len(set(bimodal.__all__)) == len(bimodal.__all__)


def test_options_have_the_same_names():
    assert set(bimodal.Options.__annotations__) == kept(members("Options"))


def test_a_sample_is_asked_for_by_the_same_names():
    request = kept(members("SampleRequest")) | {"height"}
    assert set(inspect.signature(bimodal.sample).parameters) == request


def test_an_estimator_has_the_same_methods():
    source = (ROOT / "js/estimator.ts").read_text().split("export class Estimator {")[1].split("\n}\n")[0]
    names = re.findall(r"^  (?:async |get |static )?([a-z]\w*)\(", source, re.MULTILINE)
    assert {"stepStage", "report", "points", "restore"} <= set(names)
    own = {name for name in vars(bimodal.Estimator) if not name.startswith("_")}
    assert own == kept(set(names) - {"constructor"})


def test_names_are_spelled_by_one_rule():
    from bimodal_stereo._native import spelled as own

    for name in ["offDegrees", "lambda", "startTolerance", "start.angles.beta", "lambda.prior"]:
        assert own(name) == ".".join(map(spelled, name.split(".")))
    assert own("options.stopDegrees") == "stop_degrees"


def test_a_run_ends_with_a_code_and_its_numbers(near):
    report = near(max_iterations=1, registration="icp").run()
    assert report.reason == {"code": "iteration-cap", "iterations": 1}
    assert report.message == "the limit of 1 iterations was reached"
    assert bimodal.CODES["runs"][report.reason["code"]]["remedy"]
    matrix = report.pose.matrix
    assert matrix.shape == (4, 4) and (matrix[:3, 3] == report.pose.translation).all()


def test_a_pose_starts_by_its_matrix(near):
    pose = near().report.pose
    scaled = pose.matrix.copy()
    scaled[:3, :3] *= 2
    start = near(start={"matrix": scaled}, scale="free", registration="fixed").report.pose
    assert abs(start.scale / pose.scale - 2) < 1e-12 and abs(start.rotation - pose.rotation).max() < 1e-12


def test_errors_name_entry_and_value(near):
    with pytest.raises(bimodal.BimodalError) as caught:
        near(light=[0.0] * 5 + [float("inf")] + [0.0] * 21)
    assert (caught.value.code, caught.value.field, caught.value.index) == ("range", "light", 5)


ROWS = """import { OPTIONS, paths } from "./pkg/options.js"; console.log(JSON.stringify([...paths(OPTIONS, "options")]))"""


@pytest.mark.skipif(NODE is None or not (ROOT / "pkg/options.js").exists(), reason="needs Node and the package in pkg/ (npm run build)")
def test_options_have_the_same_ranges_and_words(near):
    found = subprocess.run([NODE, "--input-type=module", "-e", ROWS], cwd=ROOT, check=True, capture_output=True)
    rows = [(path.split(".")[1:], row) for path, row in json.loads(found.stdout)]
    assert len(rows) > 20
    for path, row in rows:
        for value, is_inside in judged(row) if path[0] not in LEFT_OUT else []:
            inner = value
            for name in reversed(path[1:]):
                inner = {spelled(name): inner}
            try:
                near(**{spelled(path[0]): inner})
                assert is_inside, (path, value)
            except bimodal.BimodalError as error:
                assert not is_inside and error.field == ".".join(map(spelled, path)), (path, value, str(error))


def judged(row):
    """Values of a row, and whether it accepts each of them: its words, and numbers on both sides of its limits."""
    yield from ((word, True) for word in row.get("words", {}))
    if row["kind"] not in ("number", "whole"):
        return
    step = 1 if row["kind"] == "whole" else 1e-9
    for end, outward, inclusive in [("min", -1, True), ("max", 1, True), ("above", -1, False), ("below", 1, False)]:
        # Beyond this number, rounding loses a step of one. In Python a seed has 64 bits.
        if abs(row.get(end, 1e9)) < 1e9:
            yield row[end], inclusive
            yield row[end] + outward * step * max(1, abs(row[end])) * (1 if inclusive else -1), not inclusive


def bindings(path):
    """Functions and methods of a file, with the names of their arguments."""

    def own(body):
        return {each.name: [arg.arg for arg in each.args.args] for each in body if isinstance(each, ast.FunctionDef)}

    tree = ast.parse((ROOT / "python" / path).read_text())
    [estimator] = [each for each in tree.body if isinstance(each, ast.ClassDef)]
    return own(tree.body), own(estimator.body)


def test_pyodide_has_the_same_bindings():
    for native, pyodide in zip(bindings("bimodal_stereo/_native.pyi"), bindings("pyodide/_native.py")):
        native.pop("__new__", None)
        assert len(native) > 10 and {name: pyodide.get(name) for name in native} == native
