"""A robot astride an edge, and one on terrain that is unknown."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from odometry.recording.run_terrains import Footing
from odometry.replays.estimates import Replay
from odometry.replays.learned_parameters import learned_parameters
from odometry.replays.terrain_sources import ReplayedFooting
from tests.odometry.estimation.icr_ekf_drives import driven, filter_of, frame, table

A, B = np.array([0.4, -0.4, 0.0, 1.0, 1.0]), np.array([0.3, -0.35, 0.1, 0.9, 1.0])
TERRAINS = {"a": table(0.4, -0.4, 0), "b": table(0.3, -0.35, 0.1, 0.02, alpha_left=0.9)}


def of_terrain(estimate):
    """ICRs and slip factors, (5,)."""
    return np.concatenate([estimate.belief.icrs, estimate.belief.alphas])


def carried(ekf, estimate, shares, *, pose=None):
    """One frame after another, 0.1 s apart, each on the share of b that is given."""
    for share in shares:
        on = {name: s for name, s in {"a": 1 - share, "b": share}.items() if s > 0}
        footing = Footing("b" if share > 0.5 else "a", on)
        at = frame(estimate.stamp_s + 0.1, pose, speeds=(0.5, 0.5))
        estimate = ekf.step(estimate, at, footing)
    return estimate


def test_a_footing_on_the_terrain_in_force_is_its_name():
    ekf = filter_of(terrains=TERRAINS)
    start = driven(ekf)
    at = frame(start.stamp_s + 0.1, (0.1, 0.0, 0.0), speeds=(0.5, 0.5))
    by_name, by_footing = (ekf.step(start, at, on) for on in ("a", Footing("a", {"a": 1.0})))
    np.testing.assert_array_equal(by_footing.mean, by_name.mean)
    np.testing.assert_array_equal(by_footing.covariance, by_name.covariance)
    assert by_footing.recent == by_name.recent
    assert by_footing.terrain == "a"


def test_icrs_move_from_one_terrain_to_the_other_by_shares():
    ekf = filter_of(terrains=TERRAINS)
    start = driven(ekf)
    left = of_terrain(start)
    for shares, expected in [
        ([0.25], left + 0.25 * (B - left)),
        ([0.25, 0.5, 0.9], left + 0.9 * (B - left)),
        ([0.1, 0.6, 1.0], B),
        ([0.3, 0.7, 0.2, 0.0], left),
        ([1.0], B),
    ]:
        np.testing.assert_allclose(of_terrain(carried(ekf, start, shares)), expected, atol=1e-12)


def test_a_crossing_opens_the_covariance_by_what_a_switch_resets_it_to():
    ekf = filter_of(terrains=TERRAINS, reset_sigma_widths=0.3, icr_noise_widths=0.0)
    start = driven(ekf)
    over = carried(ekf, start, [0.25, 0.5, 0.75, 1.0])
    opened = over.covariance[3:6, 3:6] - start.covariance[3:6, 3:6]
    np.testing.assert_allclose(opened, 0.15**2 * np.eye(3), atol=1e-4)
    assert over.crossing is None
    assert np.linalg.eigvalsh(over.covariance).min() > -1e-12


def test_what_is_learned_astride_counts_for_no_terrain_that_is_left():
    """Poses that say otherwise pull at the ICRs during the crossing alone."""
    ekf = filter_of(terrains=TERRAINS)
    start = driven(ekf)
    astride = carried(ekf, start, [0.3, 0.5, 0.6], pose=start.mean[:3] + 0.03)
    assert astride.crossing is not None
    over = carried(ekf, astride, [1.0])
    np.testing.assert_array_equal(over.learned["a"].icrs, start.belief.icrs)
    assert set(over.learned) == {"a"}


def test_astride_estimates_are_no_knowledge_of_a_terrain():
    ekf = filter_of(terrains=TERRAINS)
    start = driven(ekf)
    pose = tuple(start.mean[:3])
    whole = carried(ekf, start, [0.0], pose=pose)
    astride = carried(ekf, whole, [0.4], pose=pose)
    learned = learned_parameters(ekf.parameters, Replay((start, whole, astride)), "run")
    assert learned.terrains["a"].values["y_left"] == pytest.approx(whole.belief.icrs[0])


def test_a_replay_can_follow_the_terrain_of_another():
    ekf = filter_of(terrains=TERRAINS)
    estimates = [ekf.start(frame(0, (0, 0, 0), speeds=(0.5, 0.5)), "a")]
    for share in (0.0, 0.4, 0.7, 1.0, 1.0):
        estimates.append(carried(ekf, estimates[-1], [share]))
    replayed = ReplayedFooting(tuple(estimates))
    again = estimates[0]
    for estimate in estimates[1:]:
        at = frame(estimate.stamp_s, None, speeds=(0.5, 0.5))
        again = ekf.step(again, at, replayed.terrain(at, again))
        np.testing.assert_array_equal(again.mean, estimate.mean)
    assert replayed.initial == "a"


def test_the_footing_is_that_at_or_before_each_stamp():
    """Held between estimates, the first one before them, the last one after them."""
    ekf = filter_of(terrains=TERRAINS)
    estimates = [ekf.start(frame(0, (0, 0, 0), speeds=(0.5, 0.5)), "a")]
    for share in (0.0, 0.4, 0.4, 1.0):
        estimates.append(carried(ekf, estimates[-1], [share]))
    replayed = ReplayedFooting(tuple(estimates))

    def at(stamp_s):
        return replayed.terrain(frame(stamp_s, None, speeds=(0.5, 0.5)), estimates[0])

    for before, after in pairwise(estimates):
        middle_s = (before.stamp_s + after.stamp_s) / 2
        for stamp_s, estimate in ((before.stamp_s, before), (middle_s, before)):
            crossing = estimate.crossing
            shares = {estimate.terrain: 1.0} if crossing is None else crossing.shares
            assert at(stamp_s).shares == shares
    assert at(-1.0) == at(0.0)
    assert at(1e3) == at(estimates[-1].stamp_s)


def test_unknown_terrain_keeps_the_icrs_and_teaches_none():
    ekf = filter_of(terrains=TERRAINS, reset_sigma_widths=0.3, icr_noise_widths=0.0)
    start = driven(ekf)
    at = frame(start.stamp_s + 0.1, None, speeds=(0.5, 0.5))
    lost = ekf.step(start, at, "unknown")
    np.testing.assert_array_equal(lost.belief.icrs, start.belief.icrs)
    opened = np.diag(lost.covariance - start.covariance)[3:6]
    np.testing.assert_allclose(opened, 0.15**2, rtol=0.01)
    later = ekf.step(lost, frame(at.stamp_s + 0.1, None, speeds=(0.5, 0.5)), "unknown")
    np.testing.assert_allclose(
        np.diag(later.covariance)[3:6], np.diag(lost.covariance)[3:6], rtol=1e-6
    )
    back = ekf.step(later, frame(at.stamp_s + 0.2, None, speeds=(0.5, 0.5)), "a")
    assert set(back.learned) == {"a"}
    np.testing.assert_array_equal(back.learned["a"].icrs, start.belief.icrs)
    estimates = (start, lost, later, back)
    assert set(learned_parameters(ekf.parameters, Replay(estimates), "run").terrains) == {"a", "b"}


@settings(max_examples=25, deadline=None)
@given(st.lists(st.sampled_from([0.0, 0.2, 0.5, 0.8, 1.0]), min_size=1, max_size=12))
def test_any_crossing_ends_on_the_icrs_of_its_shares(shares):
    """No pose is measured: the ICRs in force are those of the last whole footing, mixed."""
    ekf = filter_of(terrains=TERRAINS)
    start = ekf.start(frame(0, (0, 0, 0), speeds=(0.5, 0.5)), "a")
    end = carried(ekf, start, shares)
    np.testing.assert_allclose(of_terrain(end), A + shares[-1] * (B - A), atol=1e-9)
    assert np.linalg.eigvalsh(end.covariance).min() > -1e-12
    assert (end.crossing is None) == (shares[-1] in (0.0, 1.0))
