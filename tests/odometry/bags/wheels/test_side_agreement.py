"""Wheels of one side that contradict each other are not averaged without a word."""

import numpy as np
import pytest

from odometry.errors import BagError
from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import RADIUS_M, Bag, course

NAMES = ["front_left_wheel", "front_right_wheel", "rear_left_wheel", "rear_right_wheel"]
SIX = [*NAMES, "middle_left_wheel", "middle_right_wheel"]
COURSE = np.array(list(course(30.0)))


def bag_of(change, names=NAMES, *, places=False):
    """Wheels of the course; `change` alters rates [rad/s] (N, k) of the names."""
    rates = np.array([COURSE[:, 1 + ("right" in name)] / RADIUS_M for name in names]).T
    rng = np.random.default_rng(1)
    rates = change(rates + rng.normal(0, 0.05, rates.shape))
    bag = Bag("mcap")
    turned = np.cumsum(rates, axis=0) * 0.05
    for row, (t_s, *_) in enumerate(COURSE):
        moved = (turned[row], np.zeros(0)) if places else (np.zeros(len(names)), rates[row])
        bag.joints(t_s, list(names), *moved)
    return bag


def times(place, factor, rows=slice(None)):
    def change(rates):
        rates[rows, place] *= factor
        return rates

    return change


def speeds(bag, tmp_path, **options):
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"), **options)
    return run.odometry.stack("v_left", "v_right"), said


def true(rows=slice(None)):
    return pytest.approx(COURSE[rows, 1:3], abs=0.05)


@pytest.mark.parametrize("places", [False, True])
def test_a_wheel_that_never_moves_is_left_out_and_named(places, tmp_path):
    found, said = speeds(bag_of(times(2, 0.0), places=places), tmp_path)
    rows = COURSE[1:] if places else COURSE
    assert found[:, 0] == pytest.approx(rows[:, 1], abs=0.05)
    assert any("Left out: rear_left_wheel, at zero all the time" in note for note in said.notes)


@pytest.mark.parametrize(
    ("place", "factor", "words", "kept"),
    [
        (3, -1.0, "rear_right_wheel turns against front_right_wheel", "lf,lr rf"),
        (1, -1.0, "front_right_wheel turns against rear_right_wheel", "lf,lr rr"),
        (2, 3.0, r"rear_left_wheel turns 3\.\d* times as fast as front_left", "lf rf,rr"),
        (0, 0.5, r"front_left_wheel turns 0\.5\d* times as fast as rear_left", "lr rf,rr"),
    ],
)
def test_the_odd_one_of_two_wheels_is_named_with_the_way_out(place, factor, words, kept, tmp_path):
    short = {"lf": NAMES[0], "rf": NAMES[1], "lr": NAMES[2], "rr": NAMES[3]}
    sides = [",".join(short[one] for one in side.split(",")) for side in kept.split()]
    way_out = f"--left {sides[0]} --right {sides[1]}$"
    bag = bag_of(times(place, factor))
    with pytest.raises(BagError, match=f"{words}.*by the other side.*{way_out}"):
        speeds(bag, tmp_path)
    options = dict(
        zip(("wheels__left", "wheels__right"), (s.split(",") for s in sides), strict=True)
    )
    run, said = imported(tmp_path / "again", tmp_path / "drive", **options)
    assert run.odometry.stack("v_left", "v_right") == true()
    assert not any("contradict" in note for note in said.notes)


def test_both_sides_may_have_an_odd_wheel(tmp_path):
    def change(rates):
        return times(3, -1.0)(times(2, 3.0)(rates))

    with pytest.raises(BagError, match=r"--left front_left_wheel --right front_right_wheel$"):
        speeds(bag_of(change), tmp_path)


def test_a_wheel_that_dies_on_the_way_is_named(tmp_path):
    bag = bag_of(times(2, 0.0, slice(300, None)))
    with pytest.raises(BagError, match="rear_left_wheel stays at zero in 50 % of the time"):
        speeds(bag, tmp_path)


@pytest.mark.parametrize("place", [0, 3])
def test_a_wheel_that_keeps_its_last_speed_is_named(place, tmp_path):
    """A driver that hears a wheel no more goes on with the last that it heard."""

    def change(rates):
        rates[200:, place] = rates[200, place]
        return rates

    bag = bag_of(change)
    with pytest.raises(BagError, match=f"{NAMES[place]} keeps one speed to the last digit in 6"):
        speeds(bag, tmp_path)


def test_wheels_that_keep_one_speed_together_are_right(tmp_path):
    """A simulator without noise, whose robot drives on evenly."""
    rates = np.repeat([[4.0], [2.0], [5.0]], 200, axis=0) * [1.0, 1.0, 1.1, 1.1]
    found, _ = speeds(bag_of(lambda _: rates), tmp_path)
    np.testing.assert_allclose(found[:, 0], rates[:, [0, 2]].mean(axis=1) * RADIUS_M)


def test_the_odd_one_of_three_is_known_without_the_other_side(tmp_path):
    bag = bag_of(times(4, 1.5), SIX)
    with pytest.raises(BagError, match=r"middle_left_wheel turns 1.5\d* times as fast as the oth"):
        speeds(bag, tmp_path)


def test_a_wheel_of_another_course_is_named(tmp_path):
    def change(rates):
        rates[:, 2] = 4 * np.sign(np.sin(np.arange(len(rates)) / 20))
        return rates

    with pytest.raises(BagError, match="rear_left_wheel has little to do with front_left_wheel"):
        speeds(bag_of(change), tmp_path)


def test_wheels_that_the_user_states_are_averaged_with_a_warning_unless_one_is_broken(tmp_path):
    sides = {"wheels__left": NAMES[::2], "wheels__right": NAMES[1::2]}
    found, said = speeds(bag_of(times(2, 1.5)), tmp_path, **sides)
    assert found[:, 0] == pytest.approx(1.25 * COURSE[:, 1], abs=0.05)
    assert any(note.startswith("warning: wheels of a side contradict") for note in said.notes)
    dead = bag_of(times(2, 0.0)).write(tmp_path / "dead")
    with pytest.raises(BagError, match="rear_left_wheel stays at zero in 100 % of the time"):
        imported(tmp_path / "second", dead, **sides)


@pytest.mark.parametrize("factor", [0.85, 1.0, 1.15])
def test_wheels_that_slip_by_another_share_are_averaged(factor, tmp_path):
    found, said = speeds(bag_of(times(2, factor)), tmp_path)
    assert found[:, 0] == pytest.approx((1 + factor) / 2 * COURSE[:, 1], abs=0.05)
    assert not any("contradict" in note for note in said.notes)


def test_single_ticks_of_an_encoder_do_not_contradict(tmp_path):
    tick = 2 * np.pi / 100

    def ticks(rates):
        places = np.floor(np.cumsum(rates, axis=0) * 0.05 / tick + [0, 0.3, 0.5, 0.8]) * tick
        return np.diff(places, axis=0, prepend=0) / 0.05

    found, said = speeds(bag_of(ticks), tmp_path)
    assert found.mean(axis=0) == pytest.approx(COURSE[:, 1:3].mean(axis=0), abs=0.05)
    assert not any("contradict" in note for note in said.notes)
