"""Clocks of another rate, also where a lag grows by more within a piece than it is uncertain."""

from dataclasses import replace

import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.recording import check_recording
from odometry.checks.stamps.timing import found_in
from odometry.checks.statistics.lag import Lag
from odometry.recording.run import Run
from tests.odometry.checks.drives import turning_all_round
from tests.odometry.checks.faulty import pose_stamps

REAL = (
    *("warthog_grass_20240729_1404", "warthog_grass_20240729_1446", "warthog_grass_20240808_1556"),
    *("husky_tile_20231212_1616_s00", "marmotte_boreal_20240125_1215_s02"),
)


def rate_of(finding):
    """Growth of the lag, and its standard deviation, in per cent."""
    words = finding.seen.split(" grows by ")[1].split(" ms ")[0]
    return [float(number) / 10 for number in words.split(" +- ")]


def of_rate(percent):
    return lambda t: t[0] + (1 + percent / 100) * (t - t[0])


@pytest.mark.parametrize(
    ("name", "percent"),
    [
        *zip(REAL, (2.0, -3.0, -2.0, 3.0, 2.0), strict=True),
        *(("simulated", percent) for percent in (-3.0, 3.0)),
    ],
)
def test_a_clock_that_runs_fast_or_slow_is_named_with_its_rate(shared_data, name, percent):
    motion = shared_data / "motion"
    run = turning_all_round() if name == "simulated" else Run.read(motion / name)
    (found,) = check_recording(pose_stamps(run, of_rate(percent))).findings[:1]
    assert found.name == "clocks_apart", found.line
    rate, sigma = rate_of(found)
    assert sigma < 0.2
    assert rate == pytest.approx(percent / (1 + percent / 100), abs=4 * sigma + 0.05)


def test_a_robot_that_stops_while_its_clock_drifts_has_not_lost_its_odometry(shared_data):
    run = Run.read(shared_data / "motion" / "warthog_grass_20240808_1556")
    names = [f.name for f in check_recording(pose_stamps(run, of_rate(3.0))).findings]
    assert names == ["clocks_apart"]


def test_a_lag_that_grows_is_no_constant_one():
    """Also where it grows too unevenly for clocks that run apart."""
    evidence, pair = Evidence(turning_all_round()), ("pose", "gyroscope")
    constant = Lag(0.6, 0.01, 0.0, 0.0005, 0.95, 20, 0.8)
    grows = replace(constant, drift=0.01, pieces=4)
    assert [found.name for found in found_in(evidence, {pair: constant})] == ["pose_late"]
    assert list(found_in(evidence, {pair: grows})) == []
