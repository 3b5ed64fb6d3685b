"""Labels of a track whose images together are too far from every terrain."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from terrain.classification.answer import Classification
from terrain.image_labels.distance_track import DistanceTrack
from terrain.image_labels.image_label import ImageLabel
from tests.terrain.sources.watched import DARK, ByBrightness, drive

LIMITS = (10.0, 8.0, 6.0, 5.0, 4.0)  # of 1, 2, 4, 8, 16 patches


def classifier(limit=LIMITS[0]):
    return SimpleNamespace(rejection_distances_=LIMITS, rejection_distance_=limit)


def labels(distances, step_m=0.5, limit=LIMITS[0], patches=1, **of):
    """What is said of images with such distances, one every `step_m`."""
    track = DistanceTrack(classifier(limit))
    said = []
    for place, distance in enumerate(distances):
        name = "mud" if distance <= limit else "unknown"
        label = ImageLabel(0.0, "", name, class_distance=distance, patches=patches, **of)
        said.append(track.judged(label, place * step_m))
    return said


def test_four_places_beyond_the_limit_of_four_patches_are_unknown():
    said = labels([7.0] * 6)
    assert [label.label for label in said] == ["mud"] * 3 + ["unknown"] * 3
    assert "the last 2 m together" in said[-1].reason
    assert said[-1].class_distance == 7.0
    # five of the latest 2 m are compared with the limit of four to five patches, below 6
    assert {label.label for label in labels([5.5] * 6)} == {"mud"}


def test_distances_of_images_of_many_patches_are_put_on_their_own_scale():
    # 7 of one patch is 7 / 10 of the limit 6 of four patches: 4.2; sixteen have the limit 4
    assert labels([7.0] * 4, patches=4)[-1].label == "unknown"
    assert labels([6.0] * 4, patches=4)[-1].label == "mud"  # 3.6


def test_a_limit_that_was_raised_holds_for_tracks_too():
    assert labels([7.0] * 6, limit=11.0)[-1].label == "unknown"
    assert {label.label for label in labels([7.0] * 6, limit=12.5)} == {"mud"}  # 12.3


def test_a_track_forgets_and_one_odd_image_says_nothing():
    said = labels([7.0] * 5 + [2.0] * 6)
    assert [label.label for label in said[-3:]] == ["mud"] * 3
    assert labels([2.0] * 4 + [9.5] + [2.0] * 3)[4].label == "mud"


def test_a_robot_that_stands_gathers_no_evidence():
    assert {label.label for label in labels([7.0] * 50, step_m=0.001)} == {"mud"}


@pytest.mark.parametrize("of", [{"left": "mud", "right": "mud"}, {"patches": 1, "reason": "x"}])
def test_labels_of_strips_and_without_distance_stay(of):
    distances = [7.0] * 6 if "left" in of else [np.nan] * 6
    track = DistanceTrack(classifier())
    for place, distance in enumerate(distances):
        label = ImageLabel(0.0, "", "mud", class_distance=distance, **of)
        assert track.judged(label, float(place)) is label
    label = ImageLabel(0.0, "", "mud", class_distance=99.0)
    assert DistanceTrack(ByBrightness()).judged(label, 1.0) is label


@given(st.lists(st.floats(0, 20), max_size=20), st.integers(1, 20))
def test_only_names_turn_to_unknown(distances, patches):
    for distance, label in zip(distances, labels(distances, patches=patches), strict=True):
        assert label.label == "unknown" or distance <= LIMITS[0]
    assert {label.label for label in labels([min(d, 3.9) for d in distances])} <= {"mud"}


class FarAway(ByBrightness):
    """Names the bright terrain, from distances that one patch of known terrain may have."""

    rejection_distances_ = LIMITS
    rejection_distance_ = LIMITS[0]

    def classify(self, images):
        return [Classification("snow", 0.9, 7.0, {"mud": 0.1, "snow": 0.9}) for _ in images]


def test_a_stretch_that_no_terrain_is_near_does_not_come_into_force(watch):
    watched = watch([DARK] * 12, classifier=FarAway())
    drive(watched)
    names = [label.label for label in watched.watcher.image_labels]
    assert names[:3] == ["snow"] * 3
    assert set(names[3:]) == {"unknown"}
    assert watched.watcher.in_force[-1] == "unknown"
