"""What is said of a filter at the end of its run."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.icr_ekf import IcrEkf
from odometry.estimation.kept_estimates import EVERY
from odometry.estimation.transition import GYRO_BIAS
from odometry.replays.gyroscope_bias import bias_error, bias_events
from odometry.replays.pipeline import ConstantTerrain, replay
from odometry.replays.run_end import _off_at_end
from odometry.trajectory import Trajectory
from tests.odometry.preparation.test_pose_delay import run_of, table


def kinds(run, **settings):
    ekf = IcrEkf(run.robot.track_width, config=IcrEkfConfig(**settings))
    events = replay(run, ekf, ConstantTerrain("a")).events
    return {event.kind: event for event in events}


def posed(run, **columns):
    return replace(run, pose=table("pose.csv", **{**run.pose.columns, **columns}))


def test_a_clean_run_has_nothing_to_say():
    assert kinds(run_of(0.0)) == {}


def test_a_bias_is_said_and_a_drift():
    run = run_of(0.0)
    columns = dict(run.odometry.columns)
    t, rates = columns["t"], columns["gyro_z"]

    def with_rates(added):
        return replace(run, odometry=table("odometry.csv", **{**columns, "gyro_z": rates + added}))

    found = kinds(with_rates(0.016))
    assert set(found) == {"gyroscope_bias"}
    assert "bias of 0.01" in found["gyroscope_bias"].text
    lost = kinds(with_rates(0.06 * t / t[-1]))["gyroscope_drift"]
    assert "not followed" in lost.text


def test_the_error_of_a_bias_is_found_from_the_poses():
    """A drift that the filter lags behind, against the bias that was put in."""
    run = run_of(0.0)
    columns = dict(run.odometry.columns)
    t = columns["t"]
    rates = columns["gyro_z"] + 0.06 * t / t[-1]
    drifting = replace(run, odometry=table("odometry.csv", **{**columns, "gyro_z": rates}))
    ekf = IcrEkf(run.robot.track_width, config=IcrEkfConfig(watch_sensors=False))
    done = replay(drifting, ekf, ConstantTerrain("a"))
    truth = 0.06 * done.stamps_s / t[-1]
    error = truth - done.means[:, GYRO_BIAS]
    assert bias_error(done, 200) == pytest.approx(error[200:].mean(), abs=0.002)
    assert error[200:].mean() > 0.01


def test_a_drift_that_the_filter_follows_is_a_note():
    run = run_of(0.0)
    columns = dict(run.odometry.columns)
    t = columns["t"]
    rates = columns["gyro_z"] + 0.06 * t / t[-1]
    drifting = replace(run, odometry=table("odometry.csv", **{**columns, "gyro_z": rates}))
    found = kinds(drifting, bias_noise=1e-3, gyro_noise=0.005)
    assert "followed a drift" in found["gyroscope_drift_followed"].text
    assert "gyroscope_drift" not in found


def resting(run, since_s, lasts_s):
    """The run with a rest put in."""

    def later(table_of, stands):
        t = table_of.stamps_s
        of_run_s = np.minimum(t, np.maximum(since_s, t - lasts_s))
        columns = {n: np.interp(of_run_s, t, c) for n, c in table_of.columns.items() if n != "t"}
        still = (t >= since_s) & (t < since_s + lasts_s) & stands
        return {"t": t} | {name: np.where(still, 0.0, column) for name, column in columns.items()}

    return replace(
        run,
        odometry=table("odometry.csv", **later(run.odometry, True)),
        pose=table("pose.csv", **later(run.pose, False)),
    )


def test_a_yaw_that_drifts_is_no_bias_of_a_gyroscope_that_reads_none_at_rest():
    run = resting(run_of(0.0), 60.0, 6.0)
    assert not {"gyroscope_bias", "gyroscope_contradicted"} & set(kinds(run))
    t = run.pose.stamps_s
    found = kinds(posed(run, yaw=run.pose["yaw"] + 0.02 * t))
    assert "gyroscope_bias" not in found
    assert "at rest it reads 0.0000 rad/s" in found["gyroscope_contradicted"].text


def test_a_bias_that_the_gyroscope_shows_at_rest_is_one():
    run = resting(run_of(0.0), 60.0, 6.0)
    found = kinds(replace(run, odometry=table("odometry.csv", **biased(run, 0.016))))
    assert found["gyroscope_bias"].text.endswith("rad/s: it was removed")
    assert (
        "no rest shows it"
        in kinds(
            replace(run_of(0.0), odometry=table("odometry.csv", **biased(run_of(0.0), 0.016)))
        )["gyroscope_bias"].text
    )


@pytest.mark.parametrize(
    ("corrected", "kind"),
    [
        ([0.001, 0.002, 0.0], "treads_contradicted"),
        ([0.001, 0.002], "gyroscope_drift_followed"),
        ([0.001, 0.012, 0.03], "gyroscope_drift_followed"),
    ],
)
def test_a_bias_that_poses_bring_back_again_and_again_is_none_of_the_gyroscope(corrected, kind):
    biases = np.tile(np.linspace(0.0, 0.03, 50), 4)
    steps = len(biases) - 1
    kept = {
        "mean": np.tile(biases[:, None], (1, 9)),
        "tread_speeds_m_s": np.ones((len(biases), 2)),
    }
    found = SimpleNamespace(
        stamps_s=np.arange(len(biases)) * 0.1,
        events=[FilterEvent("gyroscope_bias_changed", 1, 1, "", (rad_s,)) for rad_s in corrected],
        numbers=lambda name, rows=EVERY, columns=EVERY: kept[name][rows, columns],
        sigmas_of=lambda _: np.full((len(biases), 1), 0.001),
        yaw_rates_rad_s=np.zeros(steps),
        believed_yaw_rates_rad_s=np.full(steps, np.nan),
    )
    (event,) = bias_events(found)
    assert event.kind == kind


def biased(run, rad_s):
    return {**run.odometry.columns, "gyro_z": run.odometry["gyro_z"] + rad_s}


def test_outliers_are_counted(rng):
    run = run_of(0.0)
    chosen = (rng.random(len(run.pose)) < 0.2) & (run.pose.stamps_s > 0)  # not where it starts
    x = run.pose["x"] + chosen * rng.uniform(-5, 5, len(run.pose))
    found = kinds(posed(run, x=x))
    assert set(found) == {"refused_poses"}


def test_an_outage_that_lasts_to_the_end_is_said():
    run = run_of(0.0)
    found = kinds(replace(run, pose=run.pose.rows(slice(0, 600))))
    assert set(found) == {"pose_outage"}
    assert found["pose_outage"].end_s == pytest.approx(120.0, abs=0.2)


def test_a_heading_that_was_never_found_is_said():
    run = run_of(0.0)
    standing = {**run.odometry.columns, "v_left": 0 * run.odometry["t"]}
    standing["v_right"], standing["gyro_z"] = standing["v_left"], standing["v_left"]
    rng = np.random.default_rng(3)
    x, y = rng.normal(0, 0.02, (2, len(run.pose)))
    still = posed(run, x=x, y=y, yaw=np.full(len(x), np.nan))
    found = kinds(replace(still, odometry=table("odometry.csv", **standing)))
    assert "heading_unknown" in found
    assert "cannot be determined" in found["heading_unknown"].text


def test_an_estimate_that_ends_worse_than_the_ideal_drive_says_so():
    """A filter that refuses all poses, on a wrong width that it never learns to be wrong."""
    run = run_of(0.0)
    columns = {**run.odometry.columns, "gyro_z": run.odometry["gyro_z"] + 0.1}
    biased = replace(run, odometry=table("odometry.csv", **columns))
    found = kinds(
        biased, gate_probability=1e-9, gate_patience=10**6, bias_sigma_rad_s=0.0, bias_noise=0.0
    )
    assert "off_at_end" in found
    assert "do not trust" in found["off_at_end"].text


@pytest.mark.parametrize(("off_m", "is_said"), [(0.015, False), (0.1, True)])
def test_an_end_within_the_scatter_of_the_poses_is_not_off(off_m, is_said):
    """The robot stands, where the ideal drive has it exactly; poses lie 2 cm around."""
    run = run_of(0.0)
    x, y = np.random.default_rng(3).normal(0, 0.02, (2, len(run.pose)))
    stamps_s = run.odometry.stamps_s
    at_m = [np.tile([of, 0.0, 0.0], (len(stamps_s), 1)) for of in (off_m, 0.0)]
    ours, ideal = (Trajectory(stamps_s, poses) for poses in at_m)
    done = SimpleNamespace(
        estimates=[SimpleNamespace(course=None)],
        stamps_s=stamps_s,
        trajectory=lambda: ours,
        differential_drive=lambda _: ideal,
    )
    said = [event.kind for event in _off_at_end(posed(run, x=x, y=y), done)]
    assert said == ["off_at_end"] * is_said
