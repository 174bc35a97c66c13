"""A pair that takes little time, and a report of skipped tests."""

import numpy as np
import pytest

import bimodal_stereo as bimodal

# The initial pose is near the answer.
NEAR = {"start": "identity", "scale": 1.0}


@pytest.fixture(scope="session")
def scene():
    return bimodal.sample("bust", "colourful", size=32)


@pytest.fixture
def near(scene):
    """Makes an estimator whose initial pose is near the answer."""

    def make(image=None, depth=None, **options):
        views = (scene.image if image is None else image, scene.depth if depth is None else depth)
        return bimodal.Estimator(*views, **{"light": scene.light, **NEAR, **options})

    return make


def outcome(estimator):
    """All results, bit by bit, except times."""
    report = vars(estimator.report)
    numbers = [report["iteration"], report["status"], report["residual"], report["pose"].rotation.tobytes()]
    rasters = (estimator.image_normals, estimator.image_depth, estimator.depth_normals, estimator.refined_depth)
    return numbers + [raster().tobytes() for raster in (*rasters, estimator.residual, estimator.light)]


def refused(call, code, field):
    """Checks that a call is refused with this code and field, and that the message begins with the field."""
    with pytest.raises(bimodal.BimodalError) as caught:
        call()
    error = caught.value
    assert (error.code, error.field) == (code, field), str(error)
    assert str(error).startswith(field)


def pytest_terminal_summary(terminalreporter):
    """Reports skipped tests in the form that scripts/test.mjs recognises."""
    for report in terminalreporter.stats.get("skipped", []):
        reason = report.longrepr[2].removeprefix("Skipped: ")
        terminalreporter.write_line(f"skipped: {report.nodeid.split('::')[-1]} # {reason}")


@pytest.fixture
def rng():
    return np.random.default_rng(1)
