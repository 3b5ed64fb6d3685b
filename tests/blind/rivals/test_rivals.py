"""Rivals predict the same for the drive that is given; one of a handful distinguishes them."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.recording.run import Run
from tests.blind.hidden.size import size_between
from tests.blind.rivals.cases import (
    EVERY_PAIR,
    LEAST_APART,
    MOST_BETWEEN,
    apart,
    draw_rivals,
    make_rivals,
)
from tests.blind.rivals.drives import SHAPES, Proposal, drive_of
from tests.blind.rivals.pairs import PAIRS
from tests.studies.gap.gap_names import MEANING
from tests.studies.gap.gap_next import apart as judged_apart
from tests.studies.gap.gap_next import proposal_of


@pytest.mark.parametrize("pair", EVERY_PAIR)
def test_the_given_drive_leaves_both_and_one_of_a_handful_does_not(pair):
    """With other seeds of the drives than those by which the case was drawn."""
    rng = np.random.default_rng([7, *pair.encode()])
    drawn, (measured, holdout) = draw_rivals(pair, 0, rng)
    _, (other, _) = draw_rivals(pair, 1, np.random.default_rng([7, *pair.encode()]))
    assert size_between(measured, other, drawn.scene) <= MOST_BETWEEN
    assert size_between(measured, measured, drawn.scene) == 0.0
    assert len(holdout.poses) != len(measured.poses)
    assert max(apart(rng, drawn).values()) > 0.8 * LEAST_APART


def test_there_are_40_pairs_of_rivals_and_each_has_two_names():
    assert 2 * len(PAIRS) >= 40
    for pair in EVERY_PAIR.values():
        assert pair.names[0] != pair.names[1]
        assert set(pair.names) <= set(MEANING)


@pytest.mark.parametrize("truth", [0, 1])
def test_a_proposed_drive_is_driven_with_the_truth(tmp_path, truth):
    """At half the speed wheels lose the same share, and slip by speed half of it."""
    case = make_rivals("wheels_or_slip", truth, 2, tmp_path / "case")
    assert (case.true, case.rival) == (("wheel size", "tread slip"), ("tread slip", "wheel size"))[
        truth
    ]
    given = case.drawn.given
    run = Run.read(case.drive(Proposal("straight", given.speed_m_s / 2), tmp_path / "driven"))
    x, y = run.pose.stack("x", "y").T
    seconds = run.pose.stamps_s[-1] - run.pose.stamps_s[100]
    speed = np.hypot(x[-1] - x[100], y[-1] - y[100]) / seconds
    lost = 1 - case.drawn.hides[0](None).truth["c_left"]
    expected = given.speed_m_s / 2 * (1 - (lost, lost / 2)[truth])
    assert speed == pytest.approx(expected, rel=0.004)


def test_shapes_of_drives():
    drawn, _ = draw_rivals("wheels_or_slip", 0, np.random.default_rng(0))
    asked = {
        shape: drive_of(np.random.default_rng(0), drawn.scene, Proposal(shape, 0.6, 2.0, 30.0))
        for shape in SHAPES
    }
    spin, circle, straight = (
        asked[shape].asked_m_s[-1] for shape in ("spin", "circle", "straight")
    )
    assert spin == pytest.approx([-0.6, 0.6])
    assert circle.mean() == pytest.approx(0.6)
    assert np.diff(circle) == pytest.approx(0.3 * drawn.scene.base.width)
    assert straight == pytest.approx([0.6, 0.6])
    assert {round(v, 2) for v in asked["steps"].asked_m_s[290::300, 0]} == {
        *(0.6, 0.24, 0.0, 0.42, -0.36)
    }
    for shape in ("spins", "circles", "curves"):
        difference = np.diff(asked[shape].asked_m_s, axis=1)
        assert difference.min() < 0 < difference.max()
    with pytest.raises(ValueError, match="shape = 'square'"):
        drive_of(np.random.default_rng(0), drawn.scene, Proposal("square", 0.6))


def test_a_drive_is_read_from_the_words_of_a_proposal():
    words = "circles of 1.5 m radius to both sides at 0.62 m/s, on a slope of 6 degrees"
    assert proposal_of(words) == Proposal("circles", 0.62, 1.5, slope_rad=np.deg2rad(6.0))
    assert proposal_of("spins to both sides, treads at 0.8 m/s") == Proposal("spins", 0.8)
    words = "circles of 1 m radius to both sides with steps of speed up to 0.5 m/s"
    assert proposal_of(words) == Proposal("stepped circles", 0.5, 1.0)
    with pytest.raises(ValueError, match="expected one of spins"):
        proposal_of("a square of 3 m at 0.5 m/s")


@pytest.mark.parametrize(
    ("true", "answer", "near", "expected"),
    [
        ("slope", ("unknown", "pitch"), (), ("right", "1")),
        ("slope", ("unknown", "time"), (), ("unknown", "0")),
        ("wheel size", ("unknown", "pitch"), (), ("unknown", "0")),
        ("wheel size", ("wheel_scale", ""), (("tread_slip", False),), ("right", "0")),
        ("wheel size", ("wheel_scale", ""), (("tread_slip", True),), ("right", "1")),
    ],
)
def test_what_counts_as_apart(true, answer, near, expected):
    """What depends on attitude is a slope; a rival of the same equations stays beside a name."""
    verdict, variable = answer
    found = {
        "verdict": verdict,
        "effects": [{"variable": variable}] if variable else [{}],
        "equivalent": [{"name": name, "by_equation": same} for name, same in near],
    }
    scene = SimpleNamespace(sensors=SimpleNamespace(gyroscope="imu"))
    case = SimpleNamespace(true=true, rival="tread slip", drawn=SimpleNamespace(scene=scene))
    assert tuple(judged_apart(case, found).values()) == expected
