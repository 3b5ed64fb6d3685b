"""What is said of terrains that hardly turn, and of drives that turn as another terrain does."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from odometry.modes.identify.drive_turns import LEAST_APART, MOST_NOTES, drive_turns, turn_notes
from tests.odometry.modes.mode_drives import run_of_tables, wandering

STEP_S, SIZE = 0.1, 600
BIAS_RAD_S, PULL, NOISE_RAD_S = 0.01, 0.03, 0.01


def drive(name, seed, gain, *, turn_m_s=0.5):
    """A minute in which the robot turns by `gain` for the treads, is pulled aside, has a bias."""
    rng = np.random.default_rng(seed)
    treads = wandering(rng, SIZE, STEP_S, turn_m_s=turn_m_s)
    gyro_z = gain * np.diff(treads)[:, 0] + PULL * treads.sum(axis=1) + BIAS_RAD_S
    odometry = {
        "t": STEP_S * np.arange(SIZE),
        "v_left": treads[:, 0],
        "v_right": treads[:, 1],
        "gyro_z": gyro_z + rng.normal(0, NOISE_RAD_S, SIZE),
    }
    run = run_of_tables(odometry, terrain=name)
    return replace(run, folder=Path(f"{name}_{seed}"))


def notes(*runs):
    return list(turn_notes(drive_turns(runs)))


def test_the_gain_is_found_beside_a_bias_and_a_pull():
    (one,) = drive_turns([drive("ice", 0, 1.2)])["ice"]
    assert one.run == "ice_0"
    assert one.gain_rad_m == pytest.approx(1.2, abs=5 * one.sigma_rad_m)
    assert 0 < one.sigma_rad_m < 0.01


def test_drives_that_agree_say_nothing():
    runs = [drive("ice", seed, 1.0 + 0.01 * seed) for seed in range(3)]
    runs += [drive("tar", 10 + seed, 1.1 + 0.01 * seed) for seed in range(3)]
    assert notes(*runs) == []


def test_exchanged_names_are_noted():
    right = [drive("ice", 0, 1.0), drive("tar", 1, 1.1)]
    wrong = [drive("ice", 2, 1.1), drive("tar", 3, 1.0)]
    found = notes(*right, *wrong)
    assert len(found) == MOST_NOTES + 1  # each of four drives contradicts its name
    assert found[-1] == "Further drives of which the same is true: 1."
    assert found[0].startswith("ice_0, named ice, turns the robot by")
    assert "nearer to tar_3 of tar" in found[0]
    assert "any other drive of ice (ice_2: 1.1" in found[0]


@pytest.mark.parametrize(("factor", "is_noted"), [(0.8, False), (1.3, True)])
def test_what_differs_less_than_drives_do_is_the_same(factor, is_noted):
    apart = 1 + factor * LEAST_APART
    ice, tar = ([drive(name, seed + i, gain) for i, gain in enumerate((1.0, apart))]
                for seed, name in ((0, "ice"), (2, "tar")))  # fmt: skip
    assert bool(notes(*ice, *tar)) == is_noted


@pytest.mark.parametrize("others", [1, -1])
def test_a_drive_against_its_treads_is_noted_and_no_straight_one(others):
    """Columns that are exchanged, in one drive of three or in all."""
    drives = [drive("ice", 0, -1.0), drive("ice", 1, others * 1.0), drive("ice", 2, others * 1.0)]
    found = notes(*drives, drive("tar", 3, others * 1.3), drive("tar", 4, others * 1.3))
    assert found[0].startswith("ice_0, named ice, turns the robot against its treads (-1.0")
    assert len(found) == (1 if others > 0 else MOST_NOTES + 1)
    assert not any("hardly turn" in note for note in found)


def test_terrain_that_was_driven_straight_on_is_noted():
    straight = drive("sand", 4, 1.0, turn_m_s=1e-4)
    (note,) = notes(straight, drive("ice", 0, 1.0), drive("ice", 1, 1.0))
    assert note.startswith("The runs of sand hardly turn")
    assert notes(straight, drive("sand", 5, 1.0), drive("ice", 0, 1.0)) == []


def test_a_run_without_a_yaw_rate_says_nothing():
    run = drive("ice", 0, 1.0)
    columns = {name: of for name, of in run.odometry.columns.items() if name != "gyro_z"}
    blind = replace(run, odometry=replace(run.odometry, columns=columns))
    assert drive_turns([blind]) == {}
