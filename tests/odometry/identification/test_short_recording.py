"""A short recording says what its intervals suppose."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import IdentificationError
from odometry.identification.identify import identify
from odometry.identification.report import STEADY_S, report


@pytest.fixture(scope="module")
def found(winding, stated):
    return identify([winding], "icr_symmetric", window_config=stated).terrains["gravel"]


@pytest.mark.parametrize("below", [True, False])
def test_the_time_of_all_windows_decides(found, below):
    """Windows one after the other, and one of them twice: up to 20 s, and a window more."""
    windows = found.fit.windows
    ends_s = np.array([windows.steps_s[windows.first[0] : last].sum() for last in windows.last])
    count = int(np.sum(ends_s < STEADY_S)) + (not below)
    chosen = windows.where(np.arange(len(windows)) < count)
    twice = replace(
        chosen,
        **{
            name: np.append(getattr(chosen, name), getattr(chosen, name)[:1], axis=0)
            for name in ("first", "last", "first_pose", "last_pose", "measured", "travel_m")
        },
    )
    lines = report("gravel", replace(found, fit=replace(found.fit, windows=twice)))
    said = [line for line in lines if "too short to show whether slip wanders" in line]
    assert len(said) == below
    assert not below or f"The windows last {ends_s[count - 1]:.0f} s in all" in said[0]


def test_what_lies_between_the_windows_does_not_count(found):
    """Of a run of two minutes the first and the last window."""
    windows = found.fit.windows
    names = ("first", "last", "first_pose", "last_pose", "measured", "travel_m")
    ends = replace(windows, **{name: getattr(windows, name)[[0, -1]] for name in names})
    lines = report("gravel", replace(found, fit=replace(found.fit, windows=ends)))
    spans = zip(ends.first, ends.last, strict=True)
    lasted_s = sum(windows.steps_s[first:last].sum() for first, last in spans)
    assert any(f"The windows last {lasted_s:.0f} s in all" in line for line in lines)


def test_nothing_is_said_where_nothing_has_an_interval(found):
    windows = found.fit.windows
    few = windows.where(np.arange(len(windows)) < 2)
    fit = replace(found.fit, windows=few, names=(), covariance=np.empty((0, 0)))
    lines = report("gravel", replace(found, fit=replace(fit, freedom=np.empty(0))))
    assert not any("slip wanders" in line for line in lines)


def test_windows_that_fit_any_noise_determine_nothing(winding, stated):
    """Two windows of one drive: their residuals are small, and the intervals are of metres."""
    rows = winding.wheel_travel_m < 2.3 * stated.travel_m
    columns = {name: of[rows] for name, of in winding.odometry.columns.items()}
    odometry = replace(winding.odometry, columns=columns, lines=winding.odometry.lines[rows])
    noise_m = np.random.default_rng(0).normal(0, stated.position_sigma_m, len(winding.pose))
    pose = replace(winding.pose, columns={**winding.pose.columns, "x": winding.pose["x"] + noise_m})
    noisy = replace(winding, pose=pose)
    brief = identify([replace(noisy, odometry=odometry)], "icr", window_config=stated)
    (of,) = brief.terrains.values()
    assert len(of.fit.windows) == 2
    assert of.fit.undetermined == ()
    with pytest.raises(IdentificationError, match=r"y_left: 95 % interval .* degrees of freedom"):
        brief.require_determined()
    assert identify([noisy], "icr", window_config=stated).left_open == ()
