"""Long holds of a speed: those of a log of changes are none, those that something cut out are."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from odometry.recording.run import Robot, Run
from odometry.tables.table import Table
from odometry.windows.recorded.gaps import BY_GYROSCOPE, BY_POSES, SILENT, odometry_gaps

PERIOD_S = 0.05
WIDTH_M = 0.5


def table(**columns):
    return Table(Path("table.csv"), columns, np.arange(len(columns["t"])) + 2)


def driven(seed, *, poses=True, gyroscope=True, ramp_s=PERIOD_S, noise_m_s=0.0):
    """Two minutes of speeds that stay for 1 to 6 s, then ramp to others; slip, noisy sensors."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 120.0, PERIOD_S)
    changes_s = np.cumsum(rng.uniform(1.0, 6.0, size=120))
    step = np.searchsorted(changes_s, t)
    ramp = np.full(round(ramp_s / PERIOD_S), PERIOD_S / ramp_s)
    left, right = (
        np.round(np.convolve(np.append(np.full(len(ramp) - 1, of[0]), of), ramp, "valid"), 9)
        + noise_m_s * rng.normal(size=len(t))
        for of in rng.uniform(-0.6, 1.0, size=(step.max() + 1, 2))[step].T
    )
    grip = 1 + 0.05 * np.interp(t, t[::100], rng.normal(size=len(t[::100])))
    omega = grip * (right - left) / (1.5 * WIDTH_M)
    yaw = np.cumsum(np.append(0.0, omega[:-1])) * PERIOD_S
    forward = 0.97 * (left + right) / 2
    x, y = (np.cumsum(forward * of(yaw)) * PERIOD_S for of in (np.cos, np.sin))
    rows = slice(2, None, 4)
    x, y, seen = (c[rows] + 0.01 * rng.normal(size=len(t[rows])) for c in (x, y, yaw))
    pose = table(t=t[rows], x=x, y=y, yaw=np.arctan2(np.sin(seen), np.cos(seen)))
    imu = table(t=t, gyro_z=omega + 0.02 + 0.01 * rng.normal(size=len(t)))
    odometry = table(t=t, v_left=left, v_right=right)
    return Run(
        Path("driven"),
        Robot(WIDTH_M),
        {},
        odometry,
        pose if poses else None,
        imu=imu if gyroscope else None,
    )


def with_rows(run, kept):
    """The run with some rows of odometry.csv."""
    columns = {name: column[kept] for name, column in run.odometry.columns.items()}
    return replace(run, odometry=table(**columns))


def on_change_only(run):
    """The rows that repeat the one before them are not logged, but for the last."""
    speeds = run.odometry.stack("v_left", "v_right")
    kept = np.append(True, np.any(speeds[1:] != speeds[:-1], axis=1))
    kept[-1] = True
    return with_rows(run, kept)


def without(run, begin_s, lasts_s):
    """The run without rows of odometry.csv in a time."""
    t = run.odometry.stamps_s
    return with_rows(run, (t <= begin_s) | (t >= begin_s + lasts_s))


def change_times_s(run):
    """When another turn begins: a gyroscope does not hear another speed straight on."""
    left, right = run.odometry.stack("v_left", "v_right").T
    return run.odometry.stamps_s[1:][np.abs(np.diff(right - left)) > 0.3]


SENSORS = [{}, {"gyroscope": False}, {"poses": False}]


@pytest.mark.parametrize("sensors", SENSORS, ids=["both", "poses", "gyroscope"])
@pytest.mark.parametrize("ramp_s", [0.4, 1.0])
@pytest.mark.parametrize("seed", range(3))
def test_a_log_of_changes_has_no_gap(seed, sensors, ramp_s):
    """Speeds stay for seconds, the ramps between them are logged row by row."""
    thin = on_change_only(driven(seed, ramp_s=ramp_s, **sensors))
    periods_s = np.diff(thin.odometry.stamps_s)
    assert (periods_s > 20 * np.median(periods_s)).sum() > 10
    assert len(odometry_gaps(thin)) == 0


@pytest.mark.parametrize(
    ("sensors", "reasons"),
    [
        (SENSORS[0], {BY_GYROSCOPE, BY_POSES}),
        (SENSORS[1], {BY_POSES}),
        (SENSORS[2], {BY_GYROSCOPE, SILENT}),
        ({"poses": False, "gyroscope": False}, {SILENT}),
    ],
    ids=["both", "poses", "gyroscope", "neither"],
)
def test_what_was_cut_out_where_speeds_changed_is_a_gap(sensors, reasons):
    found = set()
    for seed in range(3):
        run = driven(seed, **sensors, noise_m_s=1e-3)
        for begin_s in change_times_s(run)[1:-2:4] - 0.5:
            cut = without(run, begin_s, 2.0)
            gaps = odometry_gaps(cut)
            t = cut.odometry.stamps_s
            ((before_s, after_s),) = [p for p in pairwise(t) if p[1] - p[0] > 1.0]
            np.testing.assert_array_equal(gaps.spans_s, [[before_s, after_s]])
            found |= set(gaps.reasons)
    assert found <= reasons
    assert found & {BY_GYROSCOPE, BY_POSES} or sensors == {"poses": False, "gyroscope": False}


@pytest.mark.parametrize(("lasts_s", "gaps"), [(0.9, 0), (2.0, 1)])
@pytest.mark.parametrize("turning", [True, False])
def test_with_nothing_else_only_a_long_hold_of_turning_treads_is_a_gap(lasts_s, gaps, turning):
    run = driven(0, poses=False, gyroscope=False)
    columns = run.odometry.columns | ({} if turning else {"v_left": 0 * run.odometry["v_left"]})
    columns |= {} if turning else {"v_right": 0 * run.odometry["v_right"]}
    run = without(replace(run, odometry=table(**columns)), 20.0, lasts_s)
    assert len(odometry_gaps(run)) == (gaps if turning else 0)


def test_a_gyroscope_cannot_decide_that_a_robot_drove_on():
    """Straight on at 0.5 m/s: a log that repeats its row every 50 ms would have gone on."""
    run = driven(0, poses=False)
    straight = 0.5 * np.ones(len(run.odometry))
    imu = replace(run.imu, columns={"t": run.imu["t"], "gyro_z": 0.01 * np.sin(run.imu["t"])})
    columns = {"t": run.odometry["t"], "v_left": straight, "v_right": straight}
    run = replace(run, odometry=table(**columns), imu=imu)
    cut = odometry_gaps(without(run, 20.0, 3.0))
    assert cut.reasons.tolist() == [SILENT]
    assert len(odometry_gaps(on_change_only(run))) == 0


def test_short_steps_are_never_asked_about():
    """Up to five usual periods, whatever the poses say."""
    run = driven(0)
    t = run.odometry.stamps_s
    assert len(odometry_gaps(with_rows(run, np.arange(len(t)) % 5 != 2))) == 0
    assert len(odometry_gaps(with_rows(run, np.arange(1)))) == 0
