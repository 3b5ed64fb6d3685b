"""How shares of time, fits and answers read."""

import json

import numpy as np
import pytest

from odometry.modes.follow.camera_prior import SeenTerrain
from odometry.modes.follow.followed import followed
from odometry.modes.models.mode_set import NONE_OF_THESE
from odometry.modes.show.files import content_of
from odometry.modes.show.words import in_short, percent, scale_word, sentences
from tests.odometry.modes.mode_examples import run_of, velocity_set

ICE = ["ice"] * 400


@pytest.fixture(scope="module")
def leaving():
    """On ice for 4 s, and from there on what turns twice as much as the widest mode."""
    return followed(run_of(np.repeat([1.0, 4.0], 200), labels=ICE), velocity_set())


@pytest.mark.parametrize(
    ("share", "words"),
    [(0.984, "98 %"), (1.0, "100 %"), (-1e-16, "0 %"), (float("nan"), "-")],
)
def test_a_share_in_words(share, words):
    assert percent(share) == words


def test_sizes_in_words():
    words = [scale_word(sigmas) for sigmas in (2.9, 3.0, 6.0, 1e6)]
    assert words == ["slightly off", "clearly off", "far off", "far off"]


def test_where_no_mode_fits_it_is_said_since_when_and_in_which_signal(leaving):
    (one,) = leaving.misfits
    assert 3.8 < one.from_s < 4.5
    in_force, how_sure, to_do = in_short(leaving)
    assert in_force.startswith(f"{NONE_OF_THESE} at the end, since ")
    assert f"no mode fits from {one.from_s:.1f} s to {one.to_s:.1f} s: the yaw rate is" in how_sure
    assert to_do.startswith("check the gyroscope")
    content = content_of(leaving)
    (said,) = content["none_of_these"]
    assert (said["from_s"], said["signal"]) == (one.from_s, "wz")
    assert content["motion"]["shares_of_time"][NONE_OF_THESE] > 0.3
    assert json.dumps(content, allow_nan=False)


def test_where_the_camera_names_a_terrain_that_the_motion_does_not_fit_it_is_said():
    """On what turns twice as much as the widest mode from 0 s on, the camera says ice."""
    run = run_of(np.repeat([4.0], 400), labels=ICE)
    end_s = float(run.odometry.stamps_s[-1])
    found = followed(run, velocity_set(), seen=(SeenTerrain(0.0, "ice", 0.9),))
    unfit_s, names = found.unfit_while_seen
    assert names == ("ice",)
    assert 0.5 * end_s < unfit_s <= end_s
    said = " ".join(sentences(found))
    assert f"The motion fits no mode for {unfit_s:.1f} s in which the camera names ice" in said
    assert "neither checks the other" in said
    assert "disagree nowhere" not in said
    content = content_of(found)
    assert content["none_of_these_while_seen_s"] == unfit_s
    assert content["both_named_s"] < found.config.lasting_s


def test_none_of_these_is_neither_right_nor_wrong(leaving):
    score = leaving.score(leaving.motion)
    (detected,) = score.detected
    assert detected.none_of_these == score.none_of_these > 0.3
    assert detected.wrong < 0.1
    total = detected.right + detected.wrong + detected.undetermined + detected.none_of_these
    assert total == pytest.approx(1.0)
    assert score.wrong_of_all < 0.1


def test_a_mode_that_fits_needs_nothing_to_be_done():
    in_force, how_sure, to_do = in_short(followed(run_of(1.0, labels=ICE), velocity_set()))
    assert in_force.startswith("ice at the end, since 0.")
    assert (
        "and some mode of the set fits at every moment. Not checked: terrains that the set"
        in how_sure
    )
    assert "Not checked: the distance, without" in how_sure
    assert to_do.startswith("nothing; ")


def test_on_straights_turns_are_requested():
    run = run_of(0.0, labels=ICE)
    run.odometry.columns["v_left"][:] = run.odometry.columns["v_right"][:] = 0.5
    in_force, _, to_do = in_short(followed(run, velocity_set()))
    assert in_force == "nothing that the motion distinguishes: undetermined all the time."
    assert to_do.startswith("drive turns of several radii")
