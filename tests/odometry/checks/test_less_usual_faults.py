"""Mixed rows, stamps of another pace, stretched maps and held poses: their cause, not another."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.stamps.interleaved import interleaved
from odometry.checks.treads.tread_samples import tread_samples
from odometry.tables.table import Table
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import drive, turning_all_round, uneven
from tests.odometry.checks.faulty import put, treads, without_gyroscope, without_yaw

AT_S = 0.05 * np.arange(4000)


def at_pace(run, factor):
    def slower(table):
        return table and replace(table, columns={**table.columns, "t": factor * table["t"]})

    names = ("odometry", "pose", "imu")
    return replace(run, **{name: slower(getattr(run, name)) for name in names})


@pytest.mark.parametrize("factor", [2.0, 1 / 3])
def test_stamps_of_a_replay(factor):
    (found,) = check_recording(at_pace(uneven(), factor)).at(Level.WARNING)
    assert found.name == "stamp_pace"
    said = float(found.cause.removeprefix("Stamps run ").split()[0])
    assert said == pytest.approx(1 / factor, rel=0.03)


def test_stamps_in_minutes():
    (found,) = check_recording(at_pace(uneven(), 1 / 60)).at(Level.WARNING)
    assert (found.name, "minutes" in found.cause) == ("stamp_pace", True)


def test_without_a_gyroscope_a_pace_is_not_told_from_a_scale():
    assert "stamp_pace" not in warnings(without_gyroscope(at_pace(uneven(), 0.5)))


def interleaved_with(run, other, period_s=0.0):
    """Rows of another source between the rows of a run, all of them or one in so many seconds."""
    rows = other.odometry.rows(slice(None, None, max(round(period_s / 0.05), 1)))
    names = [name for name in run.odometry.columns if name in rows.columns]
    shifted = {name: rows[name] + 0.0123 * (name == "t") for name in names}
    joined = {n: np.append(run.odometry[n], shifted[n]) for n in names}
    order = np.argsort(joined["t"])
    table = Table(
        run.odometry.file, {n: v[order] for n, v in joined.items()}, np.arange(len(order)) + 2
    )
    return replace(run, odometry=table)


@pytest.mark.parametrize(("seed", "period_s"), [(0, 0.0), (1, 0.1)])
def test_rows_of_two_sources(seed, period_s):
    mixed = interleaved_with(uneven(seed), uneven(seed + 10), period_s)
    assert warnings(mixed) == ["interleaved_rows"]


@pytest.mark.parametrize("sigma_m_s", [0.05, 0.2])
def test_noise_of_speeds_is_no_second_source(sigma_m_s):
    rng = np.random.default_rng(1)
    noisy = treads(
        uneven(), lambda *sides: tuple(v + rng.normal(0, sigma_m_s, len(v)) for v in sides)
    )
    assert list(interleaved(Evidence(noisy))) == []


@pytest.mark.parametrize("share", [0.02, 0.15, 0.3])
def test_zeros_amid_motion_to_both_sides_are_no_second_source(share):
    rng = np.random.default_rng(3)
    both_ways = drive(0.8 * np.sin(AT_S / 5), 0.3 * np.sin(AT_S / 3))
    kept = rng.random(len(AT_S)) > share
    run = treads(both_ways, lambda *sides: tuple(v * kept for v in sides))
    assert list(interleaved(Evidence(run))) == []


@pytest.mark.parametrize("step_m_s", [0.05, 0.2, 0.4])
def test_coarse_speeds_are_no_second_source(step_m_s):
    rng = np.random.default_rng(2)

    def coarse(speeds):
        return step_m_s * np.floor(speeds / step_m_s + rng.random(len(speeds)))

    evidence = Evidence(treads(uneven(), lambda left, right: (coarse(left), coarse(right))))
    assert list(interleaved(evidence)) == []
    assert "placeholder_speeds" not in [found.name for found in tread_samples(evidence)]


@pytest.mark.parametrize("tick_m", [0.005, 0.01, 0.02])
def test_ticks_that_are_differenced_are_no_second_source(tick_m):
    """Of a few levels that differ in their last digits, as stamps of arrival have them."""
    rng = np.random.default_rng(4)

    def differenced(speeds):
        ticks = np.floor(np.cumsum(speeds * 0.05) / tick_m)
        fuzz = 1 + 1e-6 * rng.normal(size=len(speeds))
        return np.diff(ticks, prepend=0.0) * tick_m / 0.05 * fuzz

    run = treads(uneven(), lambda *sides: tuple(differenced(v) for v in sides))
    assert list(interleaved(Evidence(run))) == []


@pytest.mark.parametrize(
    ("latitude_deg", "yaw_known"), [(46.7, True), (46.7, False), (-35.0, True), (60.0, False)]
)
def test_positions_of_a_web_map(yaw_known, latitude_deg):
    run, phi = uneven(), np.radians(latitude_deg)
    north_m = 6_378_137.0 * np.log(np.tan(np.pi / 4 + phi / 2))
    x, y = (run.pose[name] / np.cos(phi) + at for name, at in (("x", 8e5), ("y", north_m)))
    run = put(run, "pose", x=x, y=y)
    assert warnings(run if yaw_known else without_yaw(run)) == ["web_map_positions"]


@pytest.mark.parametrize(("east_m", "north_m"), [(331_230.0, 5.18e6), (467_084.0, 4.23e6)])
def test_a_national_grid_is_no_web_map(east_m, north_m):
    run = turning_all_round()
    far = put(run, "pose", x=run.pose["x"] + east_m, y=run.pose["y"] + north_m)
    assert [f.name for f in check_recording(far).findings] == ["map_frame"]


def test_positions_that_are_held_beside_a_fresh_yaw_are_not_rounded():
    run = uneven()
    held = (np.arange(len(run.pose)) // 10) * 10
    assert warnings(put(run, "pose", x=run.pose["x"][held], y=run.pose["y"][held])) == [
        "repeated_poses"
    ]


@pytest.mark.parametrize("speed_m_s", [0.6, 0.1])
def test_poses_that_stay_for_the_other_half_are_frozen(speed_m_s):
    slow = np.where(AT_S < 100, 0.8, speed_m_s)
    run = without_yaw(drive(slow, 0.2 * np.sin(AT_S / 3)))
    half = len(run.pose) // 2
    rows = np.minimum(np.arange(len(run.pose)), half)
    found = warnings(put(run, "pose", x=run.pose["x"][rows], y=run.pose["y"][rows]))
    assert found == ["frozen_poses"]


def test_poses_after_the_end_of_odometry_do_not_jump():
    run = uneven()
    cut = replace(run, odometry=run.odometry.rows(slice(0, 2500)))
    assert "yaw_jumps" not in warnings(cut)


def test_ticks_whose_last_digits_differ_are_coarse():
    rng = np.random.default_rng(5)

    def differenced(speeds):
        ticks = np.diff(np.floor(np.cumsum(speeds * 0.05) / 0.02), prepend=0.0)
        return ticks * 0.4 * (1 + 1e-7 * rng.normal(size=len(speeds)))

    found = warnings(treads(uneven(), lambda *sides: tuple(differenced(v) for v in sides)))
    assert found == ["coarse_speeds"]


@pytest.mark.parametrize(("sense", "name"), [(1, "imu_unit"), (-1, "imu_mount")])
def test_gravity_of_the_other_sign_says_nothing_of_a_gyroscope_that_is_right(sense, name):
    run = uneven()
    rate = sense * run.odometry["gyro_z"]
    t = run.odometry.stamps_s
    columns = {"t": t, "gyro_z": rate, "accel_z": np.full(len(t), -9.81)}
    columns |= {axis: np.zeros(len(t)) for axis in ("accel_x", "accel_y")}
    imu = Table(run.odometry.file, columns, run.odometry.lines)
    kept = {n: c for n, c in run.odometry.columns.items() if n != "gyro_z"}
    run = replace(run, imu=imu, odometry=replace(run.odometry, columns=kept))
    assert warnings(run)[0] == name


@pytest.mark.parametrize("yaw_known", [True, False])
def test_poses_stamped_in_bursts(yaw_known):
    run = uneven()
    run = run if yaw_known else without_yaw(run)
    t = run.pose["t"].copy()
    later = np.arange(2, len(t), 3)
    t[later] = t[later - 1] + 0.001
    assert warnings(put(run, "pose", t=t)) == ["pose_bursts"]


def test_stamps_that_jitter_are_no_bursts():
    run = uneven()
    jitter = np.random.default_rng(6).uniform(-0.4, 0.4, len(run.pose))
    period_s = float(np.median(np.diff(run.pose.stamps_s)))
    assert "pose_bursts" not in warnings(put(run, "pose", t=run.pose["t"] + jitter * period_s))
