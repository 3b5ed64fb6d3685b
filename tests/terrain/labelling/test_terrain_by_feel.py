"""Labels by what the robot feels: at the right time, and none where that is not sure."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import RunFolderError
from odometry.feel.labels.felt import FeelConfig
from odometry.feel.labels.follow import follow_feel
from terrain.labelling.felt_terrain import STRETCH_S, SURE, given_by_feel
from tests.odometry.feel.feel_drives import drive, model_of_three
from tests.terrain.switch.test_feel_labels import joined


@pytest.fixture(scope="module")
def model():
    return model_of_three()


@pytest.mark.slow
def test_labels_are_of_the_moment(model):
    run, begin_s = joined(drive("gravel", 70), drive("snow", 71))
    given = given_by_feel(run, model)
    assert given.between(2.0, begin_s - 2.0) - {""} == {"gravel"}
    assert given.between(begin_s + 2.0, begin_s + 25.0) - {""} == {"snow"}
    named = [one for one in given.names if one]
    assert len(named) > 0.6 * len(given.names)
    assert not given.of_images
    assert "mean probability" in given.source


def test_a_terrain_that_ten_seconds_do_not_show_labels_nothing(model):
    before, begin_s = joined(drive("gravel", 70, seconds=15.0), drive("snow", 71, seconds=5.0))
    run, end_s = joined(before, drive("gravel", 73, seconds=15.0))
    assert end_s - begin_s == pytest.approx(5.0, abs=0.2)
    by_four_s = follow_feel(run, model, FeelConfig(stretch_s=STRETCH_S, sure=SURE))
    assert "snow" in by_four_s.lasting_answers
    assert given_by_feel(run, model).terrains == ("gravel",)


def test_what_feels_like_no_terrain_labels_nothing(model):
    with pytest.raises(RunFolderError, match="no moment feels like"):
        given_by_feel(drive("grates", 72), model)


def test_labels_know_how_sure_they_are(model):
    run, begin_s = joined(drive("gravel", 70), drive("snow", 71))
    given = given_by_feel(run, model, sure=0.7)
    sure = given.least_probability(4.0, 8.0)
    assert 0.7 <= sure <= given.probabilities.max()
    wide = given.least_probability(4.0, begin_s + 10.0)
    assert wide <= sure
    assert np.isnan(replace(given, probabilities=None).least_probability(4.0, 8.0))
    more = given_by_feel(run, model, sure=float(np.median(given.probabilities)))
    assert 0 < sum(map(bool, more.names)) < sum(map(bool, given.names))


def test_what_makes_feel_doubtful_is_said_with_the_labels(model):
    run = drive("gravel", 70)
    assert given_by_feel(run, model).notes == ()
    other = replace(run, robot=replace(run.robot, name="another"))
    (note,) = given_by_feel(other, model).notes
    assert note == "The model is of 'made', the run of 'another': be wary of the answers."
