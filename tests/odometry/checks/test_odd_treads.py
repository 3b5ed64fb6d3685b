"""Treads that no robot has, and drives that show little: the check answers, and raises nothing."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from odometry.checks.findings.catalogue import CATALOGUE
from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import drive, stepping, to_and_fro, uneven, varied
from tests.odometry.checks.faulty import SENSORS, treads, without_gyroscope, without_yaw

DRIVES = {
    "varied": varied,
    "uneven": uneven,
    "stepping": stepping,
    "to and fro": to_and_fro,
    "on the spot": lambda seed: drive(np.zeros(400), 0.5 * np.sin(np.arange(400) / 9), seed=seed),
    "never straight": lambda seed: drive(np.full(400, 0.5), np.full(400, 0.3), seed=seed),
    "of constant speed": lambda seed: drive(np.full(400, 0.5), np.zeros(400), seed=seed),
}
TREADS = {
    "as they are": lambda left, right: (left, right),
    "left negated": lambda left, right: (-left, right),
    "right negated": lambda left, right: (left, -right),
    "one the negative of the other": lambda left, _: (left, -left),
    "exchanged": lambda left, right: (right, left),
    "magnitudes": lambda left, right: (np.abs(left), np.abs(right)),
    "one lost": lambda left, right: (left, 0 * right),
    "signs alone": lambda left, right: (np.sign(left), np.sign(right)),
}
POSES = {
    "with yaw": lambda run: run,
    "without yaw": without_yaw,
    "a few": lambda run: replace(run, pose=run.pose.rows(slice(None, None, 40))),
}


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(
    st.tuples(st.sampled_from(list(DRIVES)), st.integers(0, 9)),
    st.sampled_from(list(TREADS)),
    st.sampled_from(list(POSES)),
    st.sampled_from(list(SENSORS)),
    st.sampled_from([3, 10, 40, 400, 4000]),
)
def test_nothing_makes_it_raise(driven, read, posed, sensors, rows):
    """Warnings of NumPy are errors here."""
    name, seed = driven
    run = DRIVES[name](seed)
    run = replace(run, odometry=run.odometry.rows(slice(rows)))
    report = check_recording(SENSORS[sensors](POSES[posed](treads(run, TREADS[read]))))
    assert {finding.name for finding in report.findings} <= set(CATALOGUE)


@pytest.mark.parametrize("read", ["left negated", "right negated"])
def test_a_course_that_turns_with_no_tread_is_compared_with_none(read):
    """No window of turns was left, of which a quantile was asked."""
    run = without_gyroscope(without_yaw(treads(varied(), TREADS[read])))
    assert check_recording(run).misleads
