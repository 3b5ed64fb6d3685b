"""When positions and yaw rates were measured, against the delays that were put in."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from odometry.comparison.compare import _with_poses
from odometry.comparison.config import ComparisonConfig
from odometry.geometry.angles import wrap
from odometry.positions.heading import found_heading
from odometry.positions.timing import OF_MEANING, PERIODS, TRIED_S, Timing, timings_of
from odometry.recording.run import Run
from odometry.windows.recorded import gyroscope_yaw
from odometry.windows.recorded.gyroscope_yaw import COARSE, FINE
from tests.odometry.positions_drives import drive, emptied, table
from tests.studies.identification.positions import emptied as without_yaw


def moved_in_time(of, late_s):
    return table({**of.columns, "t": of.stamps_s + late_s})


def without(of, *names):
    """A table with zeros in some columns."""
    return table({**of.columns, **{name: np.zeros(len(of.stamps_s)) for name in names}})


def late_s_of(run):
    return timings_of([emptied(run)])[0].positions_late_s


@pytest.mark.parametrize("late_s", [0.37, -0.22])
def test_late_positions_are_as_late_as_they_were_made(late_s):
    run = drive(5, noise_m=0.02, gyroscope=True)
    run = replace(run, pose=moved_in_time(run.pose, late_s))
    assert late_s_of(run) == pytest.approx(late_s, abs=0.02)


def test_positions_in_time_and_late_treads_alone_are_not_late():
    run = drive(5, noise_m=0.02, gyroscope=True)
    assert late_s_of(run) == 0.0
    assert late_s_of(replace(run, odometry=moved_in_time(run.odometry, -0.3))) == 0.0


def test_without_a_gyroscope_nothing_is_said():
    run = drive(5, noise_m=0.02)
    assert late_s_of(replace(run, pose=moved_in_time(run.pose, 0.37))) == 0.0


def test_the_yaw_of_late_positions_is_that_at_which_they_were_measured():
    run = drive(5, noise_m=0.02, gyroscope=True)
    late = replace(run, pose=moved_in_time(run.pose, 0.4))
    found = found_heading(emptied(late))
    off_rad = wrap(found.run.pose["yaw"] - run.pose["yaw"])
    assert np.sqrt(np.nanmean(off_rad**2)) < np.radians(2.0)
    assert np.array_equal(found.run.pose.stamps_s, late.pose.stamps_s)
    assert "late beside the gyroscope" in found.words


def with_means(run, early_s):
    """The run with a gyroscope at 5 Hz: means over each period, stamped earlier than its middle."""
    t, rates = run.imu.stamps_s, run.imu["gyro_z"]
    means = rates[: len(rates) // 4 * 4].reshape(-1, 4).mean(axis=1)
    middles_s = t[::4][: len(means)] + 1.5 * (t[1] - t[0])
    return replace(run, imu=table({"t": middles_s - early_s, "gyro_z": means}))


@pytest.mark.parametrize("noise_m", [0.01, 0.04])
@pytest.mark.parametrize("early_s", [0.0, 0.1, -0.1])
def test_yaw_rates_that_are_means_over_their_period_are_known_for_that(early_s, noise_m):
    """Also where most of the misfit is noise of positions: no meaning takes a tenth of it."""
    run = emptied(with_means(drive(3, noise_m=noise_m, gyroscope=True, duration_s=200.0), early_s))
    (timing,) = timings_of([run])
    assert timing == (0.0, pytest.approx(early_s))


def test_what_a_yaw_rate_means_is_the_same_in_all_runs_of_a_recorder():
    """A noisy run alone says nothing."""
    clear, noisy = (
        emptied(with_means(drive(3, noise_m=noise_m, gyroscope=True, duration_s=200.0), 0.1))
        for noise_m in (0.003, 0.3)
    )
    assert timings_of([noisy])[0].rates_early_s == 0.0
    assert timings_of([clear, noisy])[1].rates_early_s == pytest.approx(0.1)


def test_a_run_that_stands_hides_nothing_of_what_yaw_rates_mean():
    """Its path and its positions are one point, which fits any meaning."""
    run = emptied(with_means(drive(3, noise_m=0.003, gyroscope=True, duration_s=200.0), 0.1))
    still = replace(
        run,
        odometry=without(run.odometry, "v_left", "v_right"),
        imu=without(run.imu, "gyro_z"),
        pose=without(run.pose, "x", "y"),
    )
    assert [each.rates_early_s for each in timings_of([still, run])] == pytest.approx([0.1, 0.1])


def test_rates_early_by_as_much_as_treads_are_late_are_no_late_positions():
    """A drive in time shows what the rates mean, and so what is late in the other."""
    first, second = (
        with_means(drive(seed, noise_m=0.003, gyroscope=True, duration_s=200.0), 0.1)
        for seed in (3, 4)
    )
    late = replace(second, odometry=moved_in_time(second.odometry, -0.1))
    timing = timings_of([emptied(first), emptied(late)])[1]
    assert timing == (0.0, pytest.approx(0.1))


def test_late_treads_beside_rates_of_unknown_meaning_are_no_late_positions():
    run = with_means(drive(4, noise_m=0.003, gyroscope=True, duration_s=200.0), 0.1)
    late = replace(run, odometry=moved_in_time(run.odometry, -0.13))
    assert timings_of([emptied(late)])[0].positions_late_s == 0.0


def test_a_robot_that_slides_in_its_turns_is_not_late(shared_data):
    """On ice the way follows the turns late over 20 m, and not over 5 m."""
    run = Run.read(shared_data / "motion" / "warthog_ice_20240730_1630_s00")
    assert timings_of([without_yaw(run, noise_m=0.02)])[0].positions_late_s == 0.0


def test_compare_reads_the_rates_of_all_runs_alike_and_leaves_out_what_has_no_path():
    clear, noisy = (
        emptied(
            with_means(
                drive(3, noise_m=noise_m, gyroscope=True, duration_s=200.0, name=f"{noise_m}"), 0.1
            )
        )
        for noise_m in (0.003, 0.3)
    )
    short = replace(clear, folder=Path("short"), pose=clear.pose.rows(slice(2)))
    usable, reasons, _ = _with_poses([clear, short, noisy], ComparisonConfig())
    expected = found_heading(noisy, Timing(0.0, timings_of([clear, noisy])[1].rates_early_s)).run
    assert np.array_equal(usable[1].pose["yaw"], expected.pose["yaw"], equal_nan=True)
    assert list(reasons) == ["short"]


def test_yaw_rates_are_integrated_once_for_all_treads_that_are_late_beside_them(monkeypatch):
    """That takes most of a check of long positions without yaw."""
    integrated = []

    def counted(rates, steps_s):
        integrated.append(rates)
        return per_speed(rates, steps_s)

    per_speed = gyroscope_yaw._per_speed
    monkeypatch.setattr(gyroscope_yaw, "_per_speed", counted)
    run = emptied(drive(2, duration_s=40.0, gyroscope=True))
    assert timings_of([run]) == (Timing(),)
    of_bias, of_meanings = COARSE + FINE, len(OF_MEANING) * len(PERIODS)
    assert len(integrated) == of_bias + len(PERIODS) * (len(TRIED_S) + 1) + of_meanings
