"""A cause is a fact where its rivals are excluded; else the finding names them as well."""

from dataclasses import replace

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.stamps.gaps import gaps
from odometry.checks.treads.slow_speeds import or_slow
from odometry.checks.treads.tread_motion import tread_motion
from odometry.checks.treads.unsigned import unsigned
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import (
    AT_REST_S,
    PERIOD_S,
    drive,
    pausing,
    table,
    turning_all_round,
    winding,
)
from tests.odometry.checks.faulty import gyroscope, positions, put, treads, width, yaw

AT_S = PERIOD_S * np.arange(4000)


def first(run):
    return check_recording(run).at(Level.WARNING)[0]


def test_a_tread_that_slows_to_zero_may_be_in_a_dead_zone():
    """An encoder that is lost leaves a speed."""
    speed = np.interp(AT_S, [0, 60, 62, 72, 74, 200], [1.0, 1.0, 0.0, 0.0, 1.0, 1.0])
    slows = put(winding(4000), "odometry", v_left=speed)
    lost = put(slows, "odometry", v_left=np.where((AT_S > 60) & (AT_S < 74), 0.0, 1.0))
    spans = [(63.0, 71.0)]
    assert "slows down to zero" in or_slow(Evidence(slows), "v_left", spans)
    assert "slows down" not in or_slow(Evidence(lost), "v_left", spans)


def test_a_tread_that_reads_zero_elsewhere_as_well_may_be_in_a_dead_zone():
    """An encoder that was lost for a time reads zero in that time."""
    run = winding(4000)
    moves = np.where((AT_S > 60) & (AT_S < 74), 0.0, run.odometry["v_left"])
    often = np.where(AT_S % 10 < 1.5, 0.0, moves)
    spans = [(63.0, 71.0)]
    assert "reads zero at other times as well" in or_slow(
        Evidence(put(run, "odometry", v_left=often)), "v_left", spans
    )
    assert or_slow(Evidence(put(run, "odometry", v_left=moves)), "v_left", spans) == ""


def test_a_tread_that_reads_slow_speeds_as_one_is_not_lost_as_a_fact():
    speed = 0.9 + 0.6 * np.sin(AT_S / 9)
    run = drive(speed, 0.4 * np.sin(AT_S / 3))
    least = treads(run, lambda left, right: (np.maximum(left, 0.7), right))
    held = np.where((AT_S > 60) & (AT_S < 75), 0.7, run.odometry["v_left"])
    assert first(least).name == first(put(run, "odometry", v_left=held)).name == "stuck_encoder"
    assert "reads no speed between 0 and 0.7 m/s" in first(least).cause
    assert first(put(run, "odometry", v_left=held)).cause.startswith("The encoder")


def test_a_dead_zone_is_no_scale():
    run = drive(0.9 + 0.4 * np.sin(AT_S / 9), 0.1 * np.sin(AT_S / 3) + 0.12)

    def less(left, right):
        return tuple(np.sign(v) * np.maximum(np.abs(v) - 0.25, 0) for v in (left, right))

    found = first(treads(run, less))
    assert found.name == "sensors_disagree"
    assert "a dead zone" in found.seen
    scaled = first(treads(run, lambda left, right: (0.6 * left, 0.6 * right)))
    assert scaled.name in {"scale", "tread_unit"}


def test_a_dead_zone_is_no_narrow_robot():
    spins = AT_S % 20 > 6
    turn = np.where(spins, 0.9 * np.sin(AT_S / 3) + 0.8 * np.sign(np.sin(AT_S / 3)), 0.0)
    run = width(drive(np.where(spins, 0.0, 0.8), turn), 1.4)

    def less(left, right):
        return tuple(np.sign(v) * np.maximum(np.abs(v) - 0.25, 0) for v in (left, right))

    dead = treads(replace(run, pose=None), less)
    assert first(dead).name == "sensors_disagree"
    assert "track widths wide; as if" in first(dead).seen
    assert first(width(replace(run, pose=None), 1.3)).name == "track_width"


def test_a_twist_without_a_way_along_may_be_a_tread_that_is_not_read():
    def twist(left, right):
        return (left + right) / 2, (right - left) / 0.9

    run = treads(winding(), twist)
    assert first(run).cause.startswith("The columns hold the twist")
    alone = first(replace(run, pose=None))
    assert alone.name == "treads_are_twist"
    assert alone.cause.startswith("Either the columns hold the twist")


def spinning_without_signs():
    """Straight drives and turns on the spot, whose speeds differ in their last digits."""
    spins = AT_S % 20 > 10
    turn = np.where(spins, 0.5 * np.sign(np.sin(AT_S / 20)), 0.0)
    run = replace(drive(np.where(spins, 0.0, 0.8), turn), pose=None)
    return treads(run, lambda left, right: (np.abs(left), np.abs(right)))


def test_equal_numbers_may_be_one_speed_and_no_lost_signs():
    plain = first(spinning_without_signs())
    equal = first(treads(spinning_without_signs(), lambda left, _: (left, left)))
    assert plain.name == "treads_unsigned"
    assert plain.cause.startswith("Tread speeds have lost their sign")
    assert equal.cause.startswith("Either")
    assert "both columns hold one speed" in equal.cause


def test_equal_numbers_may_be_those_of_coarse_steps():
    def coarse(left, right):
        return tuple(np.round(speed / 0.344) * 0.344 for speed in (left, right))

    found = next(unsigned(Evidence(treads(spinning_without_signs(), coarse))))
    equal = next(unsigned(Evidence(treads(spinning_without_signs(), lambda left, _: (left, left)))))
    assert "steps so coarse that both read the same" in found.cause
    assert "coarse" not in equal.cause


def test_positions_alone_that_move_while_the_robot_stands_may_wander():
    run = pausing()
    aside = 8 * np.exp(-0.5 * ((run.pose.stamps_s - np.mean(AT_REST_S)) / 3) ** 2)
    found = next(tread_motion(Evidence(positions(run, lambda x, y: (x + aside, y)))))
    assert found.name == "treads_frozen"
    assert "or positions wander there" in found.cause
    begin_s, end_s = AT_REST_S
    turned = yaw(run, lambda yaw: yaw + 0.5 * np.clip(run.pose.stamps_s, begin_s, end_s))
    rests = (begin_s < AT_S) & (end_s > AT_S)
    found = next(tread_motion(Evidence(gyroscope(turned, lambda rate: rate + 0.5 * rests))))
    assert "wander" not in found.cause


def test_a_gap_as_long_as_odometry_outlasts_the_poses_may_be_of_a_clock():
    run = turning_all_round()
    ahead = put(run, "odometry", t=np.where(AT_S > 120, AT_S + 60, AT_S))
    (found,) = gaps(Evidence(ahead))
    assert found.cause.startswith("Either the clock of odometry.csv was set ahead there: the file")
    kept = (AT_S < 120) | (AT_S > 180)
    (lost,) = gaps(Evidence(replace(run, odometry=run.odometry.rows(np.flatnonzero(kept)))))
    assert lost.cause.startswith("Rows of odometry.csv are lost")


def test_turns_to_one_side_alone_may_be_of_a_tread_that_reads_too_little():
    """Where both columns are equal, a dead zone of one tread is always a turn to its side."""
    turn = 0.4 + 0.15 * np.sin(AT_S / 4)
    run = replace(drive(0.33 + 0.06 * np.sin(AT_S / 9), turn), pose=None)
    dead = treads(run, lambda left, right: (left, np.maximum(right - 0.36, 0)))
    names = [finding.name for finding in unsigned(Evidence(dead))]
    assert names == ["treads_unsigned"]
    assert next(unsigned(Evidence(dead))).cause.startswith("Either tread speeds have lost")
    lost = next(unsigned(Evidence(spinning_without_signs())))
    assert lost.cause.startswith("Tread speeds have lost their sign")


def test_one_speed_in_both_columns_is_a_fact_where_two_sensors_measure_turns():
    run = treads(winding(), lambda left, right: ((left + right) / 2, (left + right) / 2))
    assert first(run).cause.startswith("Both columns hold one speed")
    assert first(replace(run, pose=None)).cause.startswith("Either both columns")


def test_a_full_turn_of_yaw_is_what_it_steps_by_where_it_wraps():
    gon = yaw(turning_all_round(), lambda angle: 200 / np.pi * angle)
    (found,) = check_recording(gon).at(Level.WARNING)
    assert found.cause.startswith("Yaw counts 400 to a full turn")
    assert warnings(found.mend(gon)) == []


def test_a_smooth_path_may_have_a_yaw_that_is_its_course():
    """Yaw that was computed has the noise of the positions."""
    smooth = drive(np.full(2400, 0.8), 0.1 * np.sin(AT_S[:2400] / 5), yaw_sigma=1e-4, sigma_m=1e-5)
    assert first(smooth).cause.startswith("Either yaw is the course")
    rough = drive(np.full(2400, 0.8), 0.3 * np.sin(AT_S[:2400] / 5))
    x, y = rough.pose["x"], rough.pose["y"]
    course = np.arctan2(np.diff(y, append=y[-1] + 0.01), np.diff(x, append=x[-1] + 0.01))
    assert first(put(rough, "pose", yaw=course)).cause.startswith("Yaw is the course")


def resampled(run):
    """Yaw from 0 to 2 pi, of every third row, and lines between them."""
    at, whole = run.pose.stamps_s, np.mod(run.pose["yaw"], 2 * np.pi)
    return put(run, "pose", yaw=np.interp(at, at[::3], whole[::3]))


def test_yaw_interpolated_across_its_wrap_does_not_jump_as_a_fact():
    found = first(resampled(drive(np.full(4000, 0.8), 0.25 + 0.2 * np.sin(AT_S / 7))))
    assert found.name == "yaw_jumps"
    assert found.cause.startswith("Either yaw was interpolated")
    run = turning_all_round()
    half = yaw(run, lambda angle: angle + 1.5 * (run.pose.stamps_s > 100))
    assert first(half).cause.startswith("Yaw jumps")


def test_outliers_amid_rows_of_two_times_may_be_no_outliers():
    run = turning_all_round()
    columns, stamps_s = run.pose.columns, run.pose.stamps_s
    late = (stamps_s > 80) & (stamps_s < 84) & (np.arange(len(stamps_s)) % 8 == 0)
    t = np.where(late, stamps_s - 15.03, stamps_s)
    rows = np.argsort(t)
    mixed = replace(
        run, pose=table("pose.csv", **{n: c[rows] for n, c in columns.items()} | {"t": t[rows]})
    )
    outliers = [f for f in check_recording(mixed).findings if f.name == "pose_outliers"]
    assert outliers[0].cause.startswith("Either outliers")
