"""Every fault of a drive changes what it says, and the stamps stay in order."""

import re

import numpy as np
import pytest

from odometry.recording.run import Run
from tests.blind.estimation.case import reference_of, travel_m
from tests.blind.estimation.catalogue import FAULTS, make_case
from tests.blind.faults.recordings import write_recording

MOVED = {"slip_on_the_spot", "spin_on_the_spot", "carried", "towed", "slid_unseen"}


@pytest.mark.parametrize("key", FAULTS)
def test_a_case_can_be_read_and_differs_from_the_clean_run(recording, tmp_path, key):
    case = make_case(FAULTS[key], recording, "drive", 1)
    run = Run.read(write_recording(case.recording, tmp_path / "faulty"))
    clean = Run.read(recording.folder)
    same = [
        len(a) == len(b) and all(np.array_equal(a[n], b[n], equal_nan=True) for n in b.columns)
        for a, b in ((run.odometry, clean.odometry), (run.pose, clean.pose))
    ]
    assert same != [True, True]
    assert not len(run.pose.repeated_lines)
    assert recording["odometry"]["t"][0] <= case.begin_s < case.end_s


@pytest.mark.parametrize("key", sorted(FAULTS.keys() - MOVED))
def test_the_reference_is_that_of_the_clean_run(recording, key):
    case = make_case(FAULTS[key], recording, "drive", 1)
    for name, column in reference_of(recording).items():
        np.testing.assert_array_equal(case.reference[name], column)


def test_the_same_seed_draws_the_same_case_and_another_seed_another(recording):
    one, again, other = (
        make_case(FAULTS["multipath"], recording, "drive", seed) for seed in (1, 1, 2)
    )
    assert one.begin_s == again.begin_s
    np.testing.assert_array_equal(one.recording["pose"]["x"], again.recording["pose"]["x"])
    assert one.begin_s != other.begin_s


def test_half_of_the_faults_have_no_name_in_the_issue():
    named = np.mean([fault.named for fault in FAULTS.values()])
    assert 0.3 < named <= 0.5
    for fault in FAULTS.values():
        re.compile(fault.kinds)


def test_a_carried_robot_drives_on_from_its_new_place(recording):
    case = make_case(FAULTS["carried"], recording, "drive", 3)
    clean, moved = reference_of(recording), case.reference
    assert moved["t"][-1] == pytest.approx(clean["t"][-1] + 8.0)
    before, after = (np.flatnonzero(moved["t"] <= case.begin_s)[-1], None)
    after = np.flatnonzero(moved["t"] > case.end_s)[0]
    step = [moved[name][after] - moved[name][before] for name in ("x", "y")]
    assert np.hypot(*step) == pytest.approx(3.0, abs=0.1)
    assert 0.4 < abs(moved["yaw"][after] - moved["yaw"][before]) < 2.1
    speeds = np.hypot(np.diff(moved["x"]), np.diff(moved["y"])) / np.diff(moved["t"])
    assert speeds.max() < 1.0  # nowhere a jump: 0.8 m/s driven, 0.4 m/s carried


def test_slipping_on_the_spot_adds_wheel_travel_and_no_way(recording):
    case = make_case(FAULTS["slip_on_the_spot"], recording, "drive", 3)
    inside = (case.reference["t"] > case.begin_s) & (case.reference["t"] < case.end_s)
    assert np.ptp(case.reference["x"][inside]) < 0.05
    assert travel_m(case.recording, case.begin_s, case.end_s) > 1.4
