"""A unit, a sign or the order of columns that changes while recording."""

from dataclasses import replace
from itertools import cycle

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.parts.part_changes import part_changes
from odometry.checks.recording import check_recording
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import drive, to_and_fro, varied
from tests.odometry.checks.faulty import gyroscope, put, treads, without_gyroscope, yaw

SPANS = {"on": (71.3, np.inf), "until": (-np.inf, 88.8), "between": (63.2, 131.7)}


def within(table, span_s):
    return (table["t"] >= span_s[0]) & (table["t"] < span_s[1])


def of_yaw(change):
    def put_in(run, span_s):
        part = within(run.pose, span_s)
        return yaw(run, lambda angle: np.where(part, change(angle), angle))

    return put_in


def of_rate(change):
    def put_in(run, span_s):
        part = within(run.odometry, span_s)
        return gyroscope(run, lambda rate: np.where(part, change(rate), rate))

    return put_in


def of_treads(change):
    def put_in(run, span_s):
        part = within(run.odometry, span_s)
        return treads(run, lambda *both: np.where(part, change(*both), both))

    return put_in


FAULTS = {
    "yaw is in degrees": of_yaw(np.degrees),
    "yaw counts clockwise (its sign is reversed)": of_yaw(np.negative),
    "gyro_z is in degrees per second": of_rate(np.degrees),
    "gyro_z has the opposite sign": of_rate(np.negative),
    "left and right treads are exchanged": of_treads(lambda left, right: (right, left)),
    "both treads have the opposite sign": of_treads(lambda left, right: (-left, -right)),
    "v_left has the opposite sign": of_treads(lambda left, right: (-left, right)),
    "v_right has the opposite sign": of_treads(lambda left, right: (left, -right)),
}


@pytest.mark.parametrize(("words", "span"), list(zip(FAULTS, cycle(SPANS), strict=False)))
def test_a_change_is_named_with_its_moments(words, span):
    (found,) = check_recording(FAULTS[words](varied(), SPANS[span])).at(Level.WARNING)
    assert found.name == "changed_in_part"
    begin_s, end_s = SPANS[span]
    when = {"on": f"from about {begin_s:.0f} s on", "until": f"until about {end_s:.0f} s"}
    said = when.get(span, f"from about {begin_s:.0f} s to {end_s:.0f} s")
    assert found.cause.lower() == f"{said} {words.lower()}"
    assert found.spans_s[0] == pytest.approx(np.clip(SPANS[span], 0, 199.95), abs=0.6)


@pytest.mark.parametrize("words", list(FAULTS)[:2])
def test_a_yaw_without_a_gyroscope_is_compared_with_the_treads(words):
    run = FAULTS[words](without_gyroscope(varied()), SPANS["on"])
    (found,) = check_recording(run).at(Level.WARNING)
    assert found.cause == f"From about 71 s on {words}"


def test_of_two_sensors_either_may_have_changed():
    run = replace(varied(), pose=None)
    (found,) = check_recording(of_rate(np.negative)(run, SPANS["on"])).at(Level.WARNING)
    assert found.cause.startswith("Either from about 71 s on")
    assert found.cause.endswith("these cannot be distinguished")
    for words in ("gyro_z has the opposite sign", "treads are exchanged", "both treads have"):
        assert words in found.cause


def test_the_mend_undoes_the_change():
    run = varied()
    wrong = of_yaw(np.degrees)(run, SPANS["between"])
    (found,) = part_changes(Evidence(wrong))
    np.testing.assert_allclose(found.mend(wrong).pose["yaw"], run.pose["yaw"])


@pytest.mark.parametrize("make", [varied, to_and_fro])
@pytest.mark.parametrize("seed", [0, 1])
def test_nothing_changes_in_a_clean_drive(make, seed):
    assert list(part_changes(Evidence(make(seed)))) == []


@pytest.mark.parametrize("words", FAULTS)
def test_a_whole_recording_has_the_name_that_it_had(words):
    assert "changed_in_part" not in warnings(FAULTS[words](varied(), (-np.inf, np.inf)))


@pytest.mark.parametrize("side", [0, 1])
def test_a_tread_that_is_never_negative_may_have_lost_its_sign(side):
    """Where the robot drives backwards for a while that is the opposite sign as well."""
    at_s = 0.05 * np.arange(4000)
    way = np.where((at_s > 70) & (at_s < 130), -1.0, 1.0)
    run = drive(way * (0.8 + 0.1 * np.sin(at_s)), 0.4 * np.sin(at_s / 3))
    sizes = treads(run, lambda *both: [np.abs(v) if i == side else v for i, v in enumerate(both)])
    assert list(part_changes(Evidence(sizes))) == []


def test_turns_of_another_recording_have_no_change(rng):
    run = varied()
    other = np.convolve(rng.standard_normal(len(run.odometry)), np.hanning(60), "same") * 0.1
    assert "changed_in_part" not in warnings(put(run, "odometry", gyro_z=other))


def test_a_tread_in_both_columns_of_a_part_has_no_opposite_sign():
    """A robot that mostly spins: one tread is nearly the other one with its sign turned."""
    at_s = 0.05 * np.arange(4000)
    run = drive(0.05 * np.sin(at_s / 5), 0.4 * np.sin(at_s / 3) + 0.3 * np.sin(at_s / 1.7))
    part = (at_s > 62.3) & (at_s < 140.1)
    twice = treads(run, lambda left, right: (left, np.where(part, left, right)))
    assert list(part_changes(Evidence(twice))) == []
    turned = treads(run, lambda left, right: (left, np.where(part, -right, right)))
    assert [found.name for found in part_changes(Evidence(turned))] == ["changed_in_part"]
