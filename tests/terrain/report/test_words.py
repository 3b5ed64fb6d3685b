"""Sentences and numbers from scores made by hand."""

from types import SimpleNamespace

import numpy as np

from odometry.evaluation.score import Score
from terrain.config import Config
from terrain.report.tables import NOTHING, error_table
from terrain.report.words import headline

LINES = SimpleNamespace(
    result=SimpleNamespace(config=Config(), remarks=["It ends farther off."]),
    reference_name="measured pose",
    compared_with={"without vision": None, "tuned": None},
)


def of_error(metres_per_metre):
    return Score(
        7,
        np.array([0.5, 1.0, 2.0]) * metres_per_metre,
        metres_per_metre,
        np.array([1.0, 2.0, 3.0]),
        2.5,
        0.25,
        0.5,
        0.125,
    )


def scores(own, ideal, without, tuned):
    names = ("odometer", "differential drive", "odometer, without vision", "odometer, tuned")
    return dict(zip(names, map(of_error, (own, ideal, without, tuned)), strict=True))


def test_the_first_sentence_says_how_much_less_or_more():
    assert headline(LINES, scores(0.02, 0.2, 0.08, 0.016)) == (
        "Over stretches of 5 m the error of the odometer is 0.0200 m per m of wheel travel against "
        "the measured pose: 90 % less than an ideal differential drive (0.2000), 75 % less than "
        "without vision (0.0800), 25 % more than tuned (0.0160). It ends farther off."
    )


def test_the_first_sentence_counts_the_gyroscope_alone():
    own = scores(0.02, 0.2, 0.08, 0.016) | {"gyroscope, mean speed": of_error(0.015)}
    lead = headline(LINES, own)
    assert "33 % more than gyroscope with mean wheel speed (0.0150)" in lead


def test_a_rival_without_errors_is_no_rival():
    without = scores(0.02, 0.2, 0.08, 0.0) | {"odometer, without vision": Score(0)}
    sentence = headline(LINES, without)
    assert "without vision" not in sentence
    assert "no less than tuned (0.0000)." in sentence


def test_the_first_sentence_without_scores_or_horizons():
    assert "there are no errors" in headline(LINES, {})
    assert "shorter than the 5 m" in headline(LINES, {"odometer": Score(0)})


def test_the_table_is_in_metres_and_degrees_per_metre():
    rows = error_table(LINES, {"a": of_error(0.0234), "b": Score(0, mean_position_m=0.1)}).rows
    assert rows[0] == ("a", "0.0234", "0.0234", "2.5000", "2.0000", "0.250", "0.125", "0.500", "7")
    assert rows[1] == ("b", *[NOTHING] * 4, "0.100", NOTHING, NOTHING, "0")
