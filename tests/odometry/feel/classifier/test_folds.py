from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from odometry.feel.classifier.table import days_of, fold_groups, stratified_folds
from tests.odometry.feel.feel_drives import drive

LABELS = np.array(["a"] * 8 + ["b"] * 4, dtype=object)


@given(st.integers(0, 100), st.integers(2, 6))
def test_groups_stay_whole_and_terrains_are_spread(seed, folds):
    groups = np.repeat(np.arange(6), 2)
    rng = np.random.default_rng(seed)
    fold = stratified_folds(groups, LABELS, folds, rng)
    assert all(len(set(fold[groups == group])) == 1 for group in groups)
    counts = np.bincount(fold[LABELS == "a"], minlength=folds)
    assert np.ptp(counts) <= 2  # a group is two runs


def test_days_are_held_out_where_the_clock_says_and_terrains_have_two():
    days = [1_700_000_000.0 + 86_400.0 * day for day in (0, 0, 1, 1)]
    run = drive("gravel", 1, seconds=5.0)
    runs = []
    for day in days:
        columns = {**run.odometry.columns, "t": run.odometry.columns["t"] + day}
        runs.append(replace(run, odometry=replace(run.odometry, columns=columns)))
    found = days_of(runs)
    assert len(set(found)) == 2
    assert fold_groups(["a", "b", "a", "b"], found).tolist() == [0, 0, 1, 1]
    assert fold_groups(["a", "a", "b", "b"], found).tolist() == [0, 1, 2, 3]
    assert days_of([run]) is None
