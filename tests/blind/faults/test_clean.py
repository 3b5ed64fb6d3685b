"""Legal variants are legal: what was driven is what is recorded."""

import numpy as np
import pytest

from tests.blind.faults.clean import VARIANTS, is_clean, make_clean
from tests.blind.faults.recordings import read_recording
from tests.blind.faults.test_faults import contents

BY_KEY = {variant.key: variant for variant in VARIANTS}


@pytest.fixture
def variant(bases, tmp_path):
    def make(key):
        base = bases[1]
        folder = make_clean(BY_KEY[key], base, 0, tmp_path / key)
        return read_recording(base.folder), read_recording(folder)

    return make


def moved(recording, stamps):
    """Way of each tread until each stamp, held speeds."""
    table = recording["odometry"]
    steps = np.diff(table["t"])
    ways = [np.r_[0, np.cumsum(table[n][:-1] * steps)] for n in ("v_left", "v_right")]
    return np.array([np.interp(stamps, table["t"], way) for way in ways])


def test_as_it_is_is_the_same_bytes(bases, tmp_path):
    for number, base in enumerate(bases):
        folder = make_clean(BY_KEY["as_it_is"], base, 0, tmp_path / str(number))
        assert contents(folder) == contents(base.folder)


@pytest.mark.parametrize("key", sorted(BY_KEY))
def test_every_variant_can_be_written(bases, tmp_path, key):
    base = next(base for base in bases if BY_KEY[key].needs <= base.has)
    folder = make_clean(BY_KEY[key], base, 0, tmp_path / "run")
    for name, table in read_recording(folder).tables.items():
        assert (np.diff(table["t"]) > 0).all() or key == "one_repeated_row", name


def test_on_change_moves_as_before(variant):
    """At most 0.02 m/s off at any moment."""
    before, after = variant("on_change")
    stamps = before["odometry"]["t"]
    stamps = stamps[stamps < after["odometry"]["t"][-1]]
    apart = np.abs(moved(after, stamps) - moved(before, stamps))
    assert (apart < 0.02 * (stamps - stamps[0]) + 1e-9).all()
    assert len(after["odometry"]["t"]) < len(before["odometry"]["t"])
    assert np.array_equal(after["imu"]["gyro_z"], before["odometry"]["gyro_z"])


def test_a_drive_in_reverse_moves_backwards(variant):
    """Body-frame steps of the poses have the other sign, in the other order."""
    before, after = variant("backwards")

    def steps(pose):
        step = np.diff(pose["x"] + 1j * pose["y"])
        return step * np.exp(-0.5j * (pose["yaw"][1:] + pose["yaw"][:-1]))

    assert steps(after["pose"]) == pytest.approx(-steps(before["pose"])[::-1])
    assert np.sum(after["odometry"]["v_left"]) == pytest.approx(
        -np.sum(before["odometry"]["v_left"])
    )


def test_a_long_start_shifts_all_files_alike(variant):
    before, after = variant("long_start")
    waits = {n: after[n]["t"][-1] - before[n]["t"][-1] for n in ("odometry", "pose")}
    assert waits["odometry"] == pytest.approx(waits["pose"], abs=1e-6)
    assert 60 <= waits["pose"] <= 240
    still = after["odometry"]["t"] < after["odometry"]["t"][0] + 59
    assert not np.any(after["odometry"]["v_left"][still])


def test_another_world_keeps_every_motion(variant):
    before, after = variant("other_world")
    lengths = [np.hypot(np.diff(r["pose"]["x"]), np.diff(r["pose"]["y"])) for r in (before, after)]
    assert lengths[1] == pytest.approx(lengths[0], abs=1e-6)
    assert np.diff(after["pose"]["yaw"]) == pytest.approx(np.diff(before["pose"]["yaw"]), abs=1e-6)


def test_what_is_clean(bases):
    assert [is_clean(base) for base in bases] == [False, True, False, True, True]
