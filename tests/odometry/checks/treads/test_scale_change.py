"""A scale of the treads that changes, against what only looks like it."""

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.findings.undo import changed, in_turn
from odometry.checks.recording import check_recording
from odometry.checks.treads.scale_change import scale_change
from tests.odometry.checks.drives import winding
from tests.odometry.checks.faulty import treads, without_gyroscope


def later(run, v_left, v_right):
    """Tread speeds times factors from 40 % of the recording on."""
    t = run.odometry.stamps_s
    after = t > t[0] + 0.4 * np.ptp(t)
    return in_turn(
        changed("odometry", "v_left", lambda v: np.where(after, v_left * v, v)),
        changed("odometry", "v_right", lambda v: np.where(after, v_right * v, v)),
    )(run)


@pytest.mark.parametrize("factor", [0.5, 1.6, 3.6])
@pytest.mark.parametrize("gyroscope", [True, False])
def test_the_moment_and_the_mend_are_those_of_the_change(factor, gyroscope):
    run = winding()
    if not gyroscope:
        run = without_gyroscope(run)
    wrong = later(run, factor, factor)
    (finding,) = scale_change(Evidence(wrong))
    t = run.odometry.stamps_s
    assert finding.spans_s[0][0] == pytest.approx(0.4 * np.ptp(t), abs=2.0)
    mended = finding.mend(wrong)
    ratio = mended.odometry["v_left"][-20:] / run.odometry["v_left"][-20:]
    np.testing.assert_allclose(ratio, 1.0, rtol=0.1)


@pytest.mark.parametrize("factors", [(1.0, 1.0), (1.2, 1.2), (1.0, 1.8)])
def test_little_changes_and_those_of_one_tread_are_no_scale(factors):
    assert not list(scale_change(Evidence(later(winding(), *factors))))


@pytest.mark.parametrize("part", [slice(None, 600), slice(1200, None)])
def test_treads_that_read_zero_on_one_side_have_no_other_scale(part):
    run = winding()
    zero = np.ones(len(run.odometry.stamps_s))
    zero[part] = 0.0
    frozen = in_turn(
        changed("odometry", "v_left", lambda v: zero * v),
        changed("odometry", "v_right", lambda v: zero * v),
    )(run)
    assert not list(scale_change(Evidence(frozen)))


SPAN_S = (31.2, 74.9)


@pytest.mark.parametrize(("factor", "unit"), [(3.6, "km/h"), (1000.0, "mm/s")])
def test_another_unit_for_a_while_is_named_with_its_moments(factor, unit):
    run = winding()
    t = run.odometry.stamps_s
    scale = np.where((t >= SPAN_S[0]) & (t < SPAN_S[1]), factor, 1.0)
    wrong = treads(run, lambda left, right: (scale * left, scale * right))
    (found,) = check_recording(wrong).at(Level.WARNING)
    assert found.name == "tread_scale_changed"
    assert found.cause.startswith(f"From about 31 s to 75 s tread speeds are in {unit}")
    moments_s = [moment for moment, _ in found.spans_s]
    assert moments_s == pytest.approx(SPAN_S, abs=0.1)
    np.testing.assert_allclose(
        found.mend(wrong).odometry["v_left"], run.odometry["v_left"], rtol=0.1
    )
