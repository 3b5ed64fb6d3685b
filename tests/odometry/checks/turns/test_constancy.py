"""A factor is called a scale where it is the same at each speed, direction and place alone."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.recording.run import Run
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import PERIOD_S, drive, turning_all_round, winding
from tests.odometry.checks.faulty import gyroscope, positions, put, treads, width, without_gyroscope


def all_speeds():
    """Slow and fast, forwards and backwards, straight on and in turns."""
    at_s = PERIOD_S * np.arange(4000)
    speed = np.sin(at_s / 5) * (1.1 + 0.5 * np.sin(at_s / 31))
    return drive(speed, 0.5 * np.sin(at_s / 3) * (np.sin(at_s / 17) > -0.3) + 0.1)


def only_warning(run):
    (found,) = check_recording(run).at(Level.WARNING)
    return found


def compressed(speeds):
    return speeds * (1 - 0.5 * np.abs(speeds) / np.abs(speeds).max())


def scaled(factor):
    return lambda run: treads(run, lambda left, right: (factor * left, factor * right))


def in_turns_to_the_left(run, factor):
    return gyroscope(run, lambda rate: np.where(rate > 0, factor * rate, rate))


SCALES = {"scale", "tread_unit", "position_unit", "gyroscope_unit", "track_width"}
UNEVEN = {
    "speed": lambda run: treads(run, lambda left, right: (compressed(left), compressed(right))),
    "direction": lambda run: treads(
        run, lambda left, right: tuple(np.where(v > 0, 0.5 * v, v) for v in (left, right))
    ),
    "course": lambda run: positions(run, lambda x, y: (x / 0.3048, y)),
    "place": lambda run: positions(
        run, lambda x, y: (np.where(x > np.median(x), 3 * x - 2 * np.median(x), x), y)
    ),
    "turns to one side": lambda run: in_turns_to_the_left(run, 1.9),
}


@pytest.mark.parametrize("cause", UNEVEN)
def test_a_factor_that_depends_on_the_drive_is_no_scale(cause):
    named = warnings(UNEVEN[cause](all_speeds()))
    assert named
    assert not SCALES & set(named)


@pytest.mark.parametrize("factor", [0.3, 0.7])
def test_a_scale_of_the_treads_is_named(factor):
    assert warnings(scaled(factor)(all_speeds())) == ["scale"]


def test_a_factor_of_straight_lines_alone_is_no_scale():
    run = all_speeds()
    left, right = (run.odometry[name] for name in ("v_left", "v_right"))
    straight = np.abs(right - left) < 0.3 * np.abs(right + left) / 2
    slower = np.where(straight, 0.6, 1.0)
    run = put(run, "odometry", v_left=slower * left, v_right=slower * right)
    assert "scale" not in warnings(run)


@pytest.mark.parametrize("factor", [1.25, 1.35])
def test_a_gyroscope_that_reads_too_much_narrows_no_robot(factor):
    """The measured width is then odd by the gyroscope alone."""
    run = gyroscope(width(winding(), 1.4), lambda rate: factor * rate)
    assert only_warning(run).name == "sensors_disagree"


@pytest.mark.parametrize(("factor", "words"), [(57.2958, "degrees per second"), (1e3, "scale")])
def test_a_unit_of_the_gyroscope_is_told_from_a_narrow_robot_by_noisy_yaw(factor, words):
    run = winding()
    off = np.where(np.arange(len(run.pose)) % 150 == 70, 0.8, 0.0)
    run = put(run, "pose", yaw=run.pose["yaw"] + off)
    found = only_warning(gyroscope(run, lambda rate: factor * rate))
    assert found.name == "gyroscope_unit"
    assert words in found.cause


def mixed(run):
    """Each column holds three tenths of the other tread."""
    return treads(run, lambda left, right: (0.7 * left + 0.3 * right, 0.7 * right + 0.3 * left))


def test_columns_that_mix_both_treads_are_named_beside_a_wrong_track_width():
    found = only_warning(mixed(winding()))
    assert found.name == "track_width"
    assert "holds a part of the other" in found.cause
    assert "gyroscope" not in found.cause
    without = only_warning(replace(mixed(winding()), pose=None))
    assert "the gyroscope reads too much" in without.cause
    assert "tread speeds are too small" in without.cause


def test_a_width_that_explains_few_of_the_turns_is_none():
    def nearer_to_zero(left, right):
        least = np.minimum(np.abs(left), np.abs(right))
        return np.sign(left) * least, np.sign(right) * least

    at_s = PERIOD_S * np.arange(4000)
    run = drive(0.5 * np.sin(at_s / 5), 0.9 * np.sin(at_s / 3))
    assert "track_width" not in warnings(treads(run, nearer_to_zero))


def test_a_track_too_wide_and_treads_too_small_are_one_scale():
    """Treads that read half narrow the robot by half as well."""
    run = scaled(0.45)(width(all_speeds(), 1.3))
    assert warnings(run) == ["scale"]


def test_the_scale_of_one_side_holds_in_each_direction():
    def left_forwards(left, right):
        return np.where(left > 0, 0.6 * left, left), right

    at_s = PERIOD_S * np.arange(4000)
    speed = 0.9 + 0.4 * np.sin(at_s / 7) - 1.6 * (at_s % 50 > 46)
    forwards = treads(drive(speed, 0.5 * np.sin(at_s / 3)), left_forwards)
    always = treads(all_speeds(), lambda left, right: (0.6 * left, right))
    assert "treads_unequal" not in warnings(forwards)
    found = only_warning(always)
    assert found.name == "treads_unequal"
    assert "cross-talk" not in found.cause


def test_a_column_that_holds_the_sum_is_no_scale_of_one_side():
    wide = width(all_speeds(), 0.55)
    run = treads(wide, lambda left, right: (left + right, right))
    assert "treads_unequal" not in warnings(run)


def test_without_positions_a_part_of_the_other_tread_is_named_as_well():
    run = treads(replace(all_speeds(), pose=None), lambda left, right: (left + 0.3 * right, right))
    found = only_warning(run)
    assert found.name == "treads_unequal"
    assert "cross-talk" in found.cause


def unit_of_the_gyroscope(run):
    return next(f for f in check_recording(run).findings if f.name == "gyroscope_unit")


def test_a_replay_is_named_where_the_treads_go_with_the_gyroscope():
    run = gyroscope(scaled(1.38)(all_speeds()), lambda rate: 1.42 * rate)
    assert "a replay at 0.7 times the speed" in unit_of_the_gyroscope(run).cause
    alone = gyroscope(all_speeds(), lambda rate: 1.6 * rate)
    assert "replay" not in unit_of_the_gyroscope(alone).cause


def test_a_gap_has_no_windows_of_motion():
    run = turning_all_round()
    half = run.odometry.stamps_s[-1] / 2

    def set_ahead(stamps_s):
        return stamps_s + 3600.0 * (stamps_s > half)

    later = put(run, "odometry", t=set_ahead(run.odometry["t"]))
    later = put(later, "pose", t=set_ahead(run.pose["t"]))
    assert len(Evidence(later).uniform) == pytest.approx(len(Evidence(run).uniform), abs=3)


def test_a_gyroscope_that_reads_acceleration_makes_no_counters():
    run = gyroscope(winding(), lambda rate: np.gradient(rate, PERIOD_S))
    assert "treads_are_counters" not in warnings(run)


def test_early_poses_and_mirrored_ones_have_an_equivalent():
    run = winding()
    early = only_warning(put(run, "pose", t=run.pose["t"] - 0.5))
    assert "treads and gyroscope are both late" in early.cause
    late = only_warning(put(run, "pose", t=run.pose["t"] + 0.5))
    assert "both late" not in late.cause
    ned = put(run, "pose", x=run.pose["y"], y=run.pose["x"], yaw=np.pi / 2 - run.pose["yaw"])
    assert "treads are swapped, and gyro_z" in only_warning(ned).cause
    assert "treads are swapped, and gyro_z" not in only_warning(without_gyroscope(ned)).cause


def test_treads_that_depend_on_the_heading_change_no_scale(shared_data):
    """Out and back: the factor of the way out is another than that of the way back."""
    run = Run.read(shared_data / "motion" / "warthog_asphalt_slow_20240808_1146_s02")
    stamps_s = run.odometry.stamps_s
    yaw_rad = np.interp(stamps_s, run.pose.stamps_s, np.unwrap(run.pose["yaw"]))
    factor = 1 + 0.444 * np.cos(yaw_rad)
    found = only_warning(treads(run, lambda left, right: (factor * left, factor * right)))
    assert found.name == "sensors_disagree"
    assert "but with both made equal" in found.seen
