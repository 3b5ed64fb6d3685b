"""One tread that is read at another scale in a part, and what is none."""

import re

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.parts import scaled_side as room
from odometry.checks.parts.part_changes import part_changes
from odometry.checks.parts.scaled_side import scaled_side
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import varied
from tests.odometry.checks.faulty import SENSORS, treads, without_gyroscope

SPAN_S = (63.2, 131.7)


def in_part(run, change):
    part = (run.odometry["t"] >= SPAN_S[0]) & (run.odometry["t"] < SPAN_S[1])
    return treads(run, lambda *both: np.where(part, change(*both), both))


@pytest.mark.parametrize(("side", "reads"), [(0, 0.3), (1, 0.5), (1, 1.6), (0, 2.0)])
def test_the_tread_its_scale_and_the_span_are_named(reads, side):
    scales = np.ones((2, 1))
    scales[side] = reads
    wrong = in_part(varied(), lambda *both: scales * both)
    found = next(part_changes(Evidence(wrong)))
    assert warnings(wrong) == ["changed_in_part"]
    name = ("v_left", "v_right")[side]
    said = re.search(rf"{name} reads about ([\d.]+) times the motion of its tread", found.cause)
    assert float(said.group(1)) == pytest.approx(reads, rel=0.05)
    assert ("counts are lost" in found.cause) == (reads < 1)
    ((begin_s, end_s),) = found.spans_s
    assert begin_s == pytest.approx(SPAN_S[0], abs=4.0)
    assert end_s == pytest.approx(SPAN_S[1], abs=4.0)


@pytest.mark.parametrize(("sensors", "reads"), list(zip(SENSORS, (0.72, 1.37, 0.72), strict=True)))
def test_a_scale_that_slip_may_be_is_named_with_its_span_and_slip(reads, sensors):
    wrong = in_part(varied(), lambda left, right: (left, reads * right))
    (found,) = part_changes(Evidence(SENSORS[sensors](wrong)))
    assert re.search(r"v_right reads about ([\d.]+) times", found.cause).group(1) == f"{reads:.2g}"
    assert "tread slips" in found.cause
    assert found.spans_s[0] == pytest.approx(SPAN_S, abs=2.0)


def test_poses_tell_it_without_a_gyroscope():
    wrong = in_part(without_gyroscope(varied()), lambda left, right: (left, right / 2))
    (found,) = part_changes(Evidence(wrong))
    assert "v_right reads about 0.5 times" in found.cause


@pytest.mark.parametrize(
    "change",
    [
        lambda left, right: (left, right),
        lambda left, right: (left, 1.2 * right),
        lambda left, right: (left + 0.3 * (left - right), right + 0.3 * (right - left)),
        lambda left, right: (1.8 * left, 1.8 * right),
    ],
    ids=["as it is", "a terrain on which one side slips more", "a wider robot", "both treads"],
)
def test_what_is_no_other_scale_of_one_side_is_not_named(change):
    assert not list(part_changes(Evidence(in_part(varied(), change))))


def test_nothing_is_searched_where_treads_explain_turns_and_way(monkeypatch):
    searched = []
    monkeypatch.setattr(room, "_best", lambda *asked: searched.append(asked))
    evidence = Evidence(varied())
    shares = dict.fromkeys(("pose by treads", "gyroscope by treads", "way by treads"), 0.01)
    assert not list(scaled_side(evidence, shares))
    assert not searched
    assert not list(scaled_side(evidence, shares | {"way by treads": 0.03}))
    assert len(searched) == 2
