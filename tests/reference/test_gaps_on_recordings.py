"""Holds and gaps of real recordings, thinned to logs of changes, and with parts cut out."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.identification.identify import identify
from odometry.recording.run import Run
from odometry.windows.recorded.gaps import odometry_gaps

CUT_S = 2.0
SPEED_STEP_M_S = 0.05  # of a coarse encoder: its speeds often repeat
CHANGED_M_S = 0.3  # median change of a speed over what was cut out


def read(shared_data, name):
    """The run, its gyroscope in a file of its own."""
    run = Run.read(shared_data / name)
    if run.imu is not None:
        return run
    imu = replace(run.odometry, columns={name: run.odometry[name] for name in ("t", "gyro_z")})
    columns = {name: c for name, c in run.odometry.columns.items() if name != "gyro_z"}
    return replace(run, odometry=replace(run.odometry, columns=columns), imu=imu)


def with_rows(run, kept):
    columns = {name: column[kept] for name, column in run.odometry.columns.items()}
    lines = run.odometry.lines[kept]
    return replace(run, odometry=replace(run.odometry, columns=columns, lines=lines))


def coarse(run):
    speeds = {
        name: SPEED_STEP_M_S * np.round(run.odometry[name] / SPEED_STEP_M_S)
        for name in ("v_left", "v_right")
    }
    return replace(run, odometry=replace(run.odometry, columns=run.odometry.columns | speeds))


def on_change_only(run):
    speeds = run.odometry.stack("v_left", "v_right")
    kept = np.append(True, np.any(speeds[1:] != speeds[:-1], axis=1))
    kept[-1] = True
    return with_rows(run, kept)


@pytest.mark.parametrize(
    ("name", "holds"),
    [
        ("motion/warthog_grass_20240729_1446", 30),
        ("motion/warthog_asphalt_slow_20240808_1146_s00", 60),
        ("motion/marmotte_boreal_20240125_1215_s02", 30),
        ("motion/husky_tile_20231212_1616_s00", 80),
        ("motion/husky_borealtc_flooring_00", 20),
        ("feel/flooring_00", 15),
        ("feel/flooring_03", 10),
    ],
)
def test_a_log_of_changes_has_no_gap(shared_data, name, holds):
    thin = on_change_only(coarse(read(shared_data, name)))
    periods_s = np.diff(thin.odometry.stamps_s)
    assert (periods_s > 5 * np.median(periods_s)).sum() >= holds
    assert len(odometry_gaps(thin)) == 0


def cuts_where_speeds_changed(run):
    """Whether each of the cuts of a run is found, and nothing else."""
    t, speeds = run.odometry.stamps_s, run.odometry.stack("v_left", "v_right")
    for begin_s in np.arange(t[0] + 2.0, t[-1] - 2 * CUT_S, 5.0):
        gone = (t > begin_s) & (t < begin_s + CUT_S)
        held = speeds[np.flatnonzero(t <= begin_s)[-1]]
        if np.abs(np.median(speeds[gone] - held, axis=0)).max() > CHANGED_M_S:
            yield len(odometry_gaps(with_rows(run, ~gone))) == 1


def test_what_was_cut_out_where_speeds_changed_is_a_gap(shared_data):
    """But for some in which the robot moved as if the speeds had been held."""
    names = (
        "warthog_grass_20240729_1404",
        "marmotte_boreal_20240125_1215_s00",
        "husky_tile_20231212_1616_s00",
        "warthog_2023_s02",
        "warthog_asphalt_20240920_0813",
    )
    found = [
        one
        for name in names
        for one in cuts_where_speeds_changed(read(shared_data, f"motion/{name}"))
    ]
    assert len(found) > 40
    assert np.mean(found) > 0.9


@pytest.mark.parametrize(
    "name", ["warthog_grass_20240729_1446", "marmotte_boreal_20240125_1215_s00"]
)
def test_a_log_of_changes_identifies_what_the_whole_log_does(shared_data, name):
    """But for roll and pitch, of which a thinned log has fewer rows."""
    whole = coarse(read(shared_data, f"motion/{name}"))
    columns = {n: c for n, c in whole.odometry.columns.items() if n not in {"roll", "pitch"}}
    whole = replace(whole, odometry=replace(whole.odometry, columns=columns))
    first, second = (
        next(iter(identify([run], "icr_symmetric").terrains.values())).fit
        for run in (whole, on_change_only(whole))
    )
    for parameter, value in first.values.items():
        assert second.values[parameter] == pytest.approx(value, abs=1e-6)
