"""The watcher of the studies of switching answers with the true terrain, or without a name."""

import numpy as np

from odometry.estimation.icr_ekf import IcrEkf
from odometry.replays.pipeline import replay
from terrain.config import Config
from tests.studies.main_job.switching_courses import LabellingWatcher, make_course


def test_labels_that_are_all_right_are_the_true_terrains(tmp_path):
    course = make_course(tmp_path, 0, ("gravel", "grass"))
    config = Config()
    watcher = LabellingWatcher(course, config, accuracy=1.0)
    estimator = IcrEkf(course.run.robot.track_width, course.parameters, config.filter)
    replay(course.run, estimator, watcher)
    labelled = [one for one in watcher.image_labels if one.label]
    assert {one.label for one in labelled} == {"gravel", "grass"}
    assert all(one.reason for one in watcher.image_labels if not one.label)
    true = [course.true_terrain(one.stamp_s, one.region.place) for one in labelled]
    np.testing.assert_array_equal([one.label for one in labelled], true)
