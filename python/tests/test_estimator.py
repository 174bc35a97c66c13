"""The loop: its steps, its end, and other threads meanwhile."""

import os
import signal
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

import bimodal_stereo as bimodal
from conftest import outcome, refused


def test_a_run_finds_the_pose(scene, near):
    seen = []
    report = near().run(on_step=lambda report: seen.append((report.iteration, report.stage)))
    assert report.status in ("converged", "ambiguous")
    assert abs(report.pose.angles.beta - scene.pose.angles.beta) < 3
    assert seen[0] == (1, "refinement") and seen[-1][0] == report.iteration
    assert set(report.milliseconds) == {"light", "shading", "surface", "registration", "refinement"}
    assert report.pose.rotation.shape == (3, 3) and report.pose.translation.shape == (3,)
    np.testing.assert_allclose(report.pose.rotation @ report.pose.rotation.T, np.eye(3), atol=1e-9)
    assert report.energy.total == pytest.approx(sum(list(vars(report.energy).values())[:4]))
    assert report.uncertainty.rotation_degrees.shape == (3,) and report.uncertainty.scale is None


def test_matrices_are_not_transposed(scene):
    """A rotation of the sample by beta has its sine in the first row."""
    turned = bimodal.sample("bust", "colourful", size=32, angles={"beta": 30})
    assert turned.pose.rotation[0, 2] == pytest.approx(0.5) and turned.pose.rotation[2, 0] == pytest.approx(-0.5)
    told = bimodal.Estimator(turned.image, turned.depth, start=turned.pose, registration="fixed").report.pose
    np.testing.assert_allclose(told.rotation, turned.pose.rotation, atol=1e-12)
    np.testing.assert_allclose(told.translation, turned.pose.translation, atol=1e-9)


def test_stages_make_a_step(near):
    step, stages = near(), near()
    step.step()
    names = [stages.step_stage().stage for _ in range(5)]
    assert names == ["light", "shading", "surface", "registration", "refinement"]
    assert outcome(step) == outcome(stages)


def test_a_search_opens_the_loop_where_nothing_is_known(scene):
    estimator = bimodal.Estimator(scene.image, scene.depth)
    report = estimator.run(3)
    assert (report.stage, report.iteration, report.status) == ("search", 0, "running")


def test_a_run_is_limited_and_goes_on(near):
    whole, parts = near(), near()
    whole.run()
    assert parts.run(2).iteration == 2
    assert parts.run(np.int64(1)).iteration == 3
    parts.run()
    assert outcome(parts) == outcome(whole)
    assert parts.step().iteration == whole.report.iteration
    refused(lambda: near().run(0), "range", "max_iterations")
    refused(lambda: near().run(2.5), "type", "max_iterations")


def test_an_interrupt_ends_a_run_between_two_steps(near):
    interrupted, whole = near(), near()
    with pytest.raises(KeyboardInterrupt):
        interrupted.run(on_step=lambda _: os.kill(os.getpid(), signal.SIGINT))
    assert interrupted.report.iteration == 1
    interrupted.run()
    whole.run()
    assert outcome(interrupted) == outcome(whole)


def test_what_on_step_raises_ends_a_run(near):
    def enough(report):
        if report.iteration == 2:
            raise LookupError("enough")

    estimator = near()
    with pytest.raises(LookupError, match="enough"):
        estimator.run(on_step=enough)
    assert estimator.report.iteration == 2


def test_reset_begins_anew(near):
    estimator, other = near(), near(registration="icp", shading="pixel")
    estimator.run()
    first = outcome(estimator)
    estimator.reset()
    assert (estimator.report.iteration, estimator.report.status) == (0, "running")
    estimator.run()
    assert outcome(estimator) == first
    # Options replace all earlier ones.
    estimator.reset(light=other.light(), start="identity", scale=1.0, registration="icp", shading="pixel")
    estimator.run(3)
    other.run(3)
    assert outcome(estimator) == outcome(other)
    refused(lambda: estimator.reset(trim=False), "unsupported", "trim")
    refused(lambda: estimator.reset(seed=-1), "range", "seed")


def test_other_threads_run_during_a_step(scene):
    """The test does not depend on time: if a step kept the lock, the other thread would only continue after all
    steps."""
    steps = 20_000
    estimator = bimodal.Estimator(scene.image, scene.depth)
    stop = threading.Event()
    done = []

    def work():
        for count in range(steps):
            if stop.is_set():
                break
            estimator._own.step()
        done.append(count)

    interval = sys.getswitchinterval()
    # The interval is longer than the test, so that a thread yields only voluntarily.
    sys.setswitchinterval(1000)
    try:
        thread = threading.Thread(target=work)
        thread.start()
        stop.set()
        thread.join()
    finally:
        sys.setswitchinterval(interval)
    assert done[0] < steps - 1


def test_threads_share_an_estimator(near):
    shared, alone = near(), near()
    threads = [threading.Thread(target=shared.step) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for _ in threads:
        alone.step()
    assert outcome(shared) == outcome(alone)


def test_the_version_is_the_crates():
    manifest = (Path(__file__).parents[2] / "Cargo.toml").read_text()
    assert f'version = "{bimodal.__version__}"' in manifest.split("[lib]")[0]
