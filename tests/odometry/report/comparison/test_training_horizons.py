"""The heat map of training and evaluation horizons shows the medians of its errors."""

import numpy as np

from odometry.comparison.summary import Place, Summary
from odometry.comparison.training_horizons import HorizonErrors
from odometry.report.comparison.training_horizons import median_table, training_horizon_picture


def errors_of(medians, *, complete=True):
    """Errors from {(h_t, h_e): median}; rotation ten times translation."""
    found = []
    for (training_m, horizon_m), median in medians.items():
        quartiles = {"translation": np.array([0.0, median, 1.0])}
        quartiles["rotation"] = 10 * quartiles["translation"]
        place = Place("rover", "a & b", horizon_m)
        summary = Summary(place, "icr", (), (), 9, complete, {}, quartiles, ())
        found.append(HorizonErrors(training_m, summary))
    return found


def test_rows_are_training_horizons_and_columns_evaluation_horizons():
    errors = errors_of({(1.0, 0.5): 0.1, (1.0, 2.0): 0.2, (5.0, 2.0): 0.3})
    found = median_table(errors, [1.0, 5.0], [0.5, 2.0], "rotation")
    np.testing.assert_array_equal(found, [[1.0, 2.0], [np.nan, 3.0]])


def test_the_picture_is_drawn_with_holes_and_the_same_twice(tmp_path):
    errors = errors_of({(1.0, 0.5): 0.1, (1.0, 2.0): 0.0, (5.0, 2.0): 0.3})
    errors += errors_of({(9.0, 0.5): 0.1}, complete=False)
    first, second = (training_horizon_picture(errors, tmp_path / n, "icr") for n in "ab")
    assert first.file.name == "training_horizons_rover_a_b_icr.png"
    assert first.file.read_bytes() == second.file.read_bytes()
    assert "h_t" in first.caption


def test_without_a_complete_evaluation_there_is_none(tmp_path):
    errors = errors_of({(1.0, 0.5): 0.1}, complete=False)
    assert training_horizon_picture(errors, tmp_path, "icr") is None
