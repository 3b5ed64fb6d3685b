"""Sentences about where the simple does as well or better, from scores made by hand."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.estimation.filter_event import FilterEvent
from odometry.evaluation.score import Score
from terrain.result.evaluated import scatter_of_reference
from terrain.result.evaluation_notes import (
    remarks,
    simple_is_better,
    without_gyroscope_row,
    worse_at_the_end,
)


def scores(**errors):
    return {name: Score(9, None, error) for name, error in errors.items()}


def test_nothing_is_said_where_the_odometer_is_best():
    assert simple_is_better(scores(differential_drive=0.3, gyroscope=0.05, odometer=0.04)) == []
    assert worse_at_the_end({"differential_drive": 3.0, "odometer": 1.0, "estimate": 0.1}) == []
    assert worse_at_the_end({"differential_drive": 0.002, "estimate": 0.0049}) == []  # it stood


def test_the_best_of_the_simple_ones_is_named():
    (sentence,) = simple_is_better(scores(differential_drive=0.06, gyroscope=0.044, odometer=0.076))
    assert sentence == (
        "The gyroscope with mean wheel speed, which needs no fit, is better here: "
        "0.0440 against 0.0760 m per m of wheel travel."
    )
    (sentence,) = simple_is_better(scores(differential_drive=0.06, odometer=0.076))
    assert sentence.startswith("The ideal differential drive")
    (sentence,) = simple_is_better(scores(gyroscope=0.00611, odometer=0.00614))
    assert "is as good here: 0.0061 against 0.0061" in sentence


@pytest.mark.parametrize("missing", ["differential_drive", "odometer"])
def test_without_windows_nothing_is_compared(missing):
    errors = {"differential_drive": 0.01, "odometer": 0.02} | {missing: None}
    assert simple_is_better(scores(**errors)) == []


def test_each_that_ends_farther_off_than_the_ideal_drive_is_named():
    off_m = {"differential_drive": 8.2, "gyroscope": 9.0, "odometer": 30.0, "estimate": 51.7}
    odometer, estimate = worse_at_the_end(off_m)
    assert odometer == (
        "The odometer ends farther off than the ideal differential drive: 30.00 against 8.20 m."
    )
    assert estimate.startswith("The estimate ends farther off")
    assert worse_at_the_end({}) == []


def test_where_nothing_is_judged_nothing_is_remarked():
    assert remarks({}, {"differential_drive": 1.0, "estimate": 2.0}) == []


def test_an_end_that_the_filter_noticed_is_not_reported_twice():
    errors = scores(odometer=0.01)
    off_m = {"differential_drive": 8.2, "odometer": 30.0, "estimate": 51.7}
    assert len(remarks(errors, off_m)) == 2
    (left,) = remarks(errors, off_m, (FilterEvent("off_at_end", 0.0, 9.0, "do not trust it"),))
    assert left.startswith("The odometer ends farther off")


@pytest.mark.parametrize(("times", "said"), [(0, 0), (1, 0), (2, 1), (5, 1)])
def test_poses_and_odometry_that_contradict_each_other_are_said(times, said):
    again = (FilterEvent("reinitialised", 9.0, 9.0, "it started again there"),) * times
    sentences = remarks(scores(odometer=0.04, differential_drive=0.3), {}, again)
    assert len(sentences) == said
    assert all(f"started again {times} times" in sentence for sentence in sentences)


def test_what_of_the_errors_is_the_scatter_of_the_poses_is_said(rng):
    """Two ends of a window, of a trajectory without an error."""
    ends = rng.normal(scale=0.8, size=(2, 4000, 2))
    per_m = np.hypot(*(ends[1] - ends[0]).T).mean() / 5.0
    scatter = FilterEvent("noisy_positions", 0.0, 9.0, "they scatter", (0.8, 0.4))
    (sentence,) = scatter_of_reference((scatter,), "pose", 5.0)
    assert f"an error of up to {per_m:.2f} m per m" in sentence
    rounding = FilterEvent("rounded_positions", 0.0, 9.0, "they are rounded", (0.29, 0.9, 1.0))
    (sentence,) = scatter_of_reference((rounding,), "pose", 5.0)
    assert "off by about 0.29 m" in sentence
    assert scatter_of_reference((scatter,), "truth", 5.0) == []
    assert scatter_of_reference((), "pose", 5.0) == []


@pytest.mark.parametrize(
    ("share", "words"),
    [
        (0.0, "no gyroscope"),
        (0.0004, "measured for less than 1 % of the time"),
        (0.324, "measured for 32 % of the time"),
        (0.8999, "measured for 89 % of the time"),
    ],
)
def test_why_there_is_no_gyroscope_row_is_said(share, words):
    (note,) = without_gyroscope_row(SimpleNamespace(gyroscope_share=share))
    assert words in note
    assert without_gyroscope_row(SimpleNamespace(gyroscope_share=0.93)) == []
