"""Threads that share the work: the results are equal bit by bit."""

import pytest

import bimodal_stereo as bimodal
from conftest import outcome, refused


@pytest.fixture(scope="module")
def wide():
    """Large enough for the iterations to be shared as well."""
    return bimodal.sample("bust", "colourful", size=64, angles={"beta": 40}, noise=0.01)


@pytest.fixture(scope="module")
def alone(wide):
    estimator = bimodal.Estimator(wide.image, wide.depth, max_iterations=4)
    estimator.run()
    return outcome(estimator)


@pytest.mark.parametrize("workers", [2, 3])
def test_any_number_of_threads_gives_the_same_bits(workers, wide, alone):
    estimator = bimodal.Estimator(wide.image, wide.depth, max_iterations=4, workers=workers)
    reports = list(estimator)
    assert outcome(estimator) == alone
    assert "iteration" in reports[-1].milliseconds and reports[0].stage == "search"
    estimator.reset()
    estimator.run()
    assert outcome(estimator) == alone


@pytest.mark.parametrize("steps", [2, 5, 40])
def test_a_run_of_threads_is_restored(steps, wide, alone):
    estimator = bimodal.Estimator(wide.image, wide.depth, max_iterations=4, workers=2)
    estimator.run(steps)
    again = bimodal.Estimator.restore(estimator.save())
    assert outcome(again) == outcome(estimator)
    again.run()
    assert outcome(again) == alone


def test_threads_belong_to_an_estimator(near):
    estimator = near(workers=2)
    estimator.reset(workers=2, start="identity")
    refused(lambda: estimator.reset(workers=3), "option", "workers")
    refused(lambda: near(workers=0), "range", "workers")
    refused(lambda: near(workers="all"), "type", "workers")


def test_an_estimator_gives_its_reports_one_after_the_other(near):
    told = []
    expected = near(max_iterations=3)
    expected.run(on_step=lambda report: told.append((report.iteration, report.status)))
    estimator = near(max_iterations=3)
    for report in estimator:
        break
    assert report.iteration == 1
    found = [(1, "running"), *((report.iteration, report.status) for report in estimator)]
    assert found == told and outcome(estimator) == outcome(expected)
    assert list(estimator) == []
