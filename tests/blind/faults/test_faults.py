"""Every fault changes the file that it says, and no other; the same seed gives the same bytes."""

import numpy as np
import pytest

from tests.blind.faults.catalogue import FAULTS, make_case, right
from tests.blind.faults.fault import says

FILES = {
    "tread": {"odometry.csv"},
    "front_": {"odometry.csv"},
    "turn_": {"odometry.csv"},
    "odometry_": {"odometry.csv"},
    "speed_": {"odometry.csv"},
    "header_": {"odometry.csv"},
    "cells_": {"odometry.csv"},
    "columns_": {"odometry.csv"},
    "zeros_": {"odometry.csv"},
    "terrain_": {"odometry.csv"},
    "rows_lost": {"odometry.csv"},
    "rows_in_disorder": {"odometry.csv"},
    "gyro_": {"odometry.csv"},
    "velocity_": {"velocity.csv"},
    "pitch_": {"odometry.csv"},
    "roll_": {"odometry.csv"},
    "attitude_": {"odometry.csv"},
    "imu_mount": {"run.toml"},
    "pose_mount": {"run.toml"},
    "imu_": {"imu.csv"},
    "pose_in_other_time_zone": {"pose.csv", "odometry.csv"},
    "pose": {"pose.csv"},
    "track_": {"run.toml"},
    "camera_": {"run.toml"},
}


def contents(folder):
    return {
        file.relative_to(folder).as_posix(): file.read_bytes()
        for file in folder.rglob("*")
        if file.is_file()
    }


@pytest.mark.slow
@pytest.mark.parametrize("key", FAULTS)
def test_a_fault_changes_its_own_file_alone(bases, tmp_path, key):
    base = make_case(FAULTS[key], bases, 1, tmp_path / "run")
    clean, faulty = contents(base.folder), contents(tmp_path / "run")
    names = {n for n in clean.keys() | faulty.keys() if clean.get(n) != faulty.get(n)}
    assert names
    expected = next((FILES[start] for start in FILES if key.startswith(start)), None)
    if expected:
        assert names == expected
    make_case(FAULTS[key], bases, 1, tmp_path / "again")
    assert contents(tmp_path / "again") == faulty


def test_another_seed_draws_another_fault(bases, tmp_path):
    make_case(FAULTS["pose_late"], bases[:1], 1, tmp_path / "a")
    make_case(FAULTS["pose_late"], bases[:1], 2, tmp_path / "b")
    assert contents(tmp_path / "a") != contents(tmp_path / "b")


def test_faults_are_well_formed():
    for fault in FAULTS.values():
        assert fault.level in {"refused", "warning", "note"}
        assert set(fault.equal) <= set(FAULTS)
        assert fault.words
        assert not fault.harmless or fault.level == "note"
    named = np.mean([fault.named for fault in FAULTS.values()])
    assert 0.2 < named < 0.5  # most of what goes wrong has no name in advance


@pytest.mark.parametrize(
    ("key", "cause", "expected"),
    [
        ("pose_yaw_in_degrees", "Yaw is written in degrees.", True),
        ("pose_yaw_in_degrees", "Yaw is reversed.", False),
        ("stamps_in_ns", "The stamps are nanoseconds (1e9 a second).", True),
        ("stamps_in_us", "The robot must use another clock.", False),
        ("tread_left_stuck", "The left encoder is stuck.", True),
        ("tread_left_stuck", "The right encoder is stuck.", False),
        ("treads_in_km_h", "The wheel rates are in rad/s.", True),  # within 8 % at 0.3 m radius
        ("gyro_reversed", "The treads are reversed.", False),
    ],
)
def test_a_cause_is_right_by_its_words(key, cause, expected):
    assert right(FAULTS[key], "", cause) == expected


def test_a_marked_word_may_stand_in_what_was_seen():
    assert says("gyro_z is +1 rad/s", "the sign is wrong", ("@gyro sign",))
    assert not says("the sign", "of gyro_z", ("@gyro sign",))
