"""Training horizon against evaluation horizon."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.comparison.compare import compare
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.summary import Place, Summary
from odometry.comparison.training_horizons import (
    HorizonErrors,
    best_training_horizons,
    horizon_sentence,
)
from odometry.errors import ConfigError

MODELS = ["differential_drive", "icr_symmetric", "icr"]


@pytest.fixture(scope="module")
def compared(grass, quick):
    return compare(grass, MODELS, config=replace(quick, training_horizons_m=(1.0, 900.0)))


def test_the_training_horizon_of_the_comparison_takes_part_without_being_requested(compared):
    assert compared.config.training.horizon_m == 2.0
    here = [each for each in compared.by_training_horizon if each.training_m == 2.0]
    assert {each.summary.place.horizon_m for each in here} == set(compared.config.evaluated_m)
    for each in here:
        expected = {s.model: s for s in compared.summaries_at(each.summary.place)}
        summary = expected[each.summary.model]
        assert each.summary.windows == summary.windows
        assert each.summary.medians == pytest.approx(summary.medians, rel=1e-4)
        assert each.summary.means == pytest.approx(summary.means, rel=1e-12)


def test_a_training_horizon_that_is_named_twice_is_there_once(grass, quick):
    again = compare(grass, ["icr"], config=replace(quick, training_horizons_m=(1.0, 2.0)))
    asked = [each.training_m for each in again.by_training_horizon]
    assert sorted(asked) == [1.0] * 5 + [2.0] * 5
    by_time = replace(quick.training, horizon_s=3.0)
    timed = replace(quick, training=by_time, training_horizons_m=(1.0,))
    found = compare(grass, ["icr"], config=timed).by_training_horizon
    assert {each.training_m for each in found} == {1.0}  # 3 s are no wheel travel


def test_every_training_horizon_is_another_fit_on_the_same_windows(compared):
    errors = compared.horizon_errors_of("rover", "grass")["icr"]
    at_two = {e.training_m: e.summary for e in errors if e.summary.place.horizon_m == 2.0}
    assert at_two[1.0].windows == at_two[2.0].windows
    assert at_two[1.0].means != at_two[2.0].means
    assert at_two[1.0].means["translation"] < 0.02


def test_a_model_of_which_nothing_is_identified_has_no_training_horizon(compared):
    assert set(compared.horizon_errors_of("rover", "grass")) == {"icr_symmetric", "icr"}


def test_a_horizon_longer_than_any_run_takes_no_part(compared):
    errors = compared.horizon_errors_of("rover", "grass")["icr"]
    long = [each for each in errors if each.training_m == 900.0]
    assert not any(each.summary.complete for each in long)
    assert "no window of 900 m" in long[0].summary.reasons[0]
    best = best_training_horizons(errors, "translation")
    assert set(best) == set(compared.config.evaluated_m)
    assert all(900.0 not in horizons for horizons in best.values())


def test_without_training_horizons_nothing_is_done(grass, quick):
    assert compare(grass[:2], ["icr_symmetric"], config=quick).by_training_horizon == ()


def errors_of(medians):
    """Errors from {(h_t, h_e): median}."""
    found = []
    for (training_m, horizon_m), median in medians.items():
        quartiles = {q: np.array([0.0, median, 1.0]) for q in ("translation", "rotation")}
        place = Place("rover", "grass", horizon_m)
        summary = Summary(place, "icr", (), (), 9, True, {}, quartiles, ())
        found.append(HorizonErrors(training_m, summary))
    return found


def test_the_best_training_horizons_err_at_most_five_percent_more():
    """As Baril 2020 reads Fig. 4: short ones suit short evaluation horizons, long ones long."""
    errors = errors_of(
        {(1.0, 0.5): 0.1, (2.0, 0.5): 0.104, (5.0, 0.5): 0.106}
        | {(1.0, 5.0): 0.3, (2.0, 5.0): 0.2, (5.0, 5.0): 0.1}
        | {(1.0, 2.0): 0.2, (2.0, 2.0): 0.2, (5.0, 2.0): 0.2}
    )
    assert best_training_horizons(errors, "translation") == {
        0.5: (1.0, 2.0),
        2.0: (1.0, 2.0, 5.0),
        5.0: (5.0,),
    }
    assert horizon_sentence("icr", errors, "rotation") == (
        "icr, rotation, identified over windows of 1, 2 or 5 m: over 0.5 m the error with 1 or 2 m "
        "is the smallest; over 2 m the errors of all are the same; over 5 m the error with 5 m is "
        "the smallest (medians within 5 % count as equal)."
    )


def test_a_sentence_where_nothing_could_be_evaluated():
    (one,) = errors_of({(1.0, 900.0): 0.1})
    none = [HorizonErrors(1.0, replace(one.summary, complete=False))]
    assert horizon_sentence("icr", none, "rotation") == (
        "icr, rotation: no training horizon could be evaluated."
    )


@pytest.mark.parametrize("horizons_m", [(0.0,), (float("inf"),), (2.0, 2.0)])
def test_training_horizons_without_meaning_are_refused(horizons_m):
    with pytest.raises(ConfigError, match="training horizon"):
        ComparisonConfig(training_horizons_m=horizons_m)
