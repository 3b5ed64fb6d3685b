"""What is drawn of a checked recording is what the recording says."""

from pathlib import Path

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import CheckReport, Finding, Level
from odometry.recording.run import Robot, Run
from odometry.report.check_plots import (
    effective_width_m,
    marks_of,
    plot_measured_path,
    plot_tread_speeds,
    plot_yaw_rates,
)
from odometry.tables.table import Table

WIDTH_M = 0.9  # effective, of a track of 0.5 m


def table(**columns):
    count = len(columns["t"])
    return Table(Path("x.csv"), columns, np.arange(2, count + 2))


def drive(origin=(0.0, 0.0), pose=True, gyroscope=True):
    """20 s that start at 100 s; the turn rate is exactly (right - left) / WIDTH_M."""
    t = 100 + 0.05 * np.arange(400)
    left, right = 0.6 + 0.3 * np.sin(t), 0.5 + 0.3 * np.cos(0.7 * t)
    rate, forward = (right - left) / WIDTH_M, (left + right) / 2
    yaw = np.concatenate([[0.0], np.cumsum(rate[:-1] * 0.05)])
    x = origin[0] + np.concatenate([[0.0], np.cumsum(forward[:-1] * np.cos(yaw[:-1]) * 0.05)])
    y = origin[1] + np.concatenate([[0.0], np.cumsum(forward[:-1] * np.sin(yaw[:-1]) * 0.05)])
    odometry = {"t": t, "v_left": left, "v_right": right}
    if gyroscope:
        odometry["gyro_z"] = rate
    poses = table(t=t[::2], x=x[::2], y=y[::2], yaw=yaw[::2]) if pose else None
    return Run(Path("run"), Robot(0.5), {}, table(**odometry), pose=poses)


def names(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


def test_marks_are_the_spans_of_the_findings():
    findings = [
        Finding("stuck", Level.WARNING, "", "", "", ((1.0, 2.0),)),
        Finding("bias", Level.NOTE, "", "", ""),
        Finding("stuck", Level.WARNING, "", "", "", ((5.0, 5.0),)),
    ]
    marks = marks_of(CheckReport(Path("x"), tuple(findings)))
    assert list(marks) == ["stuck"]
    assert marks["stuck"].tolist() == [[1.0, 2.0], [5.0, 5.0]]


def test_speeds_over_run_time_with_marks(axes):
    run = drive()
    plot_tread_speeds(axes, Evidence(run), {"stuck": np.array([[1.0, 3.0], [5.0, 5.0]])})
    left, right = axes.lines
    assert left.get_xdata() == pytest.approx(run.odometry.stamps_s - 100)
    assert left.get_ydata() == pytest.approx(run.odometry["v_left"])
    assert right.get_ydata() == pytest.approx(run.odometry["v_right"])
    spans = [p.get_extents().transformed(axes.transData.inverted()) for p in axes.patches]
    assert (spans[0].x0, spans[0].x1) == pytest.approx((1.0, 3.0))
    assert spans[1].x0 < 5.0 < spans[1].x1  # a single sample is visible, too
    assert names(axes) == ["left tread", "right tread", "stuck"]
    assert axes.get_ylabel() == "tread speed [m/s]"


def test_one_wild_sample_does_not_set_the_limits(axes):
    run = drive()
    run.odometry.columns["v_left"][50] = 50.0
    plot_tread_speeds(axes, Evidence(run), {})
    assert axes.get_ylim()[1] < 1.5
    assert "50" in axes.texts[0].get_text()


def test_yaw_rates_of_three_sensors_lie_on_each_other(axes):
    evidence = Evidence(drive())
    width_m, how = effective_width_m(evidence)
    assert width_m == pytest.approx(WIDTH_M, rel=1e-3)
    assert "poses" in how
    plot_yaw_rates(axes, evidence, {})
    drawn = [line.get_xydata() for line in axes.lines]
    assert len(drawn) == 3
    treads, gyroscope, poses = (line[np.isfinite(line).all(axis=1)] for line in drawn)
    assert treads == pytest.approx(gyroscope, abs=1e-3)
    assert np.interp(poses[:, 0], *gyroscope.T) == pytest.approx(poses[:, 1], abs=0.05)
    assert names(axes) == [
        "treads (effective width 0.9 m, estimated from the poses)",
        "gyroscope",
        "poses",
    ]
    assert axes.get_ylabel() == "yaw rate [rad/s]"


def test_without_other_sensors_the_width_is_an_ordinary_one(axes):
    evidence = Evidence(drive(pose=False, gyroscope=False))
    assert effective_width_m(evidence) == (pytest.approx(0.9), "1.8 track widths")
    plot_yaw_rates(axes, evidence, {})
    assert len(axes.lines) == 1


def test_path_far_from_the_origin_is_drawn_less_its_start(axes):
    run = drive(origin=(4e5, 5.4e6))
    plot_measured_path(axes, Evidence(run), {"jump": np.array([[2.0, 4.0]])})
    path = axes.lines[0].get_xydata()
    assert path[0] == pytest.approx([0, 0])
    assert path == pytest.approx(run.pose.stack("x", "y") - [4e5, 5.4e6])
    assert axes.get_xlabel() == "x - 400000 [m]"
    (marked,) = [line for line in axes.lines if line.get_label() == "jump"]
    inside = (run.pose.stamps_s >= 101.95) & (run.pose.stamps_s <= 104.05)
    assert marked.get_xydata() == pytest.approx(path[inside])
    axes.figure.canvas.draw()


def test_without_poses_the_axes_say_so(axes):
    plot_measured_path(axes, Evidence(drive(pose=False)), {})
    assert axes.texts[0].get_text() == "no measured poses"
