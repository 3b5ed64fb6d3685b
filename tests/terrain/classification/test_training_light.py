"""Names that depend on the light of the images."""

from dataclasses import replace

import numpy as np
import pytest

from terrain.classification.answer import Classification
from terrain.classification.likeness.likeness import Likeness
from terrain.classification.training_light import BY_LIGHT, unless_by_light

DARK = Likeness(20, 0.5, 0.5, (), beyond=1.1, light=0.4)
IMAGE = np.full((8, 8), 40, np.uint8)


class ByGrey:
    """Mud is darker than 80, snow is not; what was classified is kept."""

    def __init__(self):
        self.greys = []

    def classify(self, images):
        self.greys += [int(image.mean()) for image in images]
        mud = [float(image.mean() < 80) for image in images]
        return [named("mud" if of else "snow", of) for of in mud]


def named(label, mud):
    return Classification(label, 1.0, 0.1, {"mud": mud, "snow": 1 - mud})


def answer_of(likeness, image=IMAGE, answer=None):
    classifier = ByGrey()
    answer = answer or classifier.classify([image])[0]
    (found,) = unless_by_light(classifier, [image], [answer], likeness)
    return found, classifier.greys


def test_what_looks_like_a_dark_terrain_in_little_light_has_no_name():
    found, greys = answer_of(DARK)
    assert found == replace(named("mud", 1.0), label="unknown", reason=BY_LIGHT)
    assert greys == [40, 100]


def test_a_name_that_stands_in_the_light_of_training_stays():
    found, greys = answer_of(DARK, IMAGE // 4)
    assert found.label == "mud"
    assert greys == [10, 25, 25]
    bright = replace(DARK, light=2.0)
    assert answer_of(bright, 5 * IMAGE)[0].label == "snow"
    assert answer_of(bright, 3 * IMAGE)[0].label == "unknown"


@pytest.mark.parametrize(
    "likeness",
    [
        None,
        replace(DARK, light=0.8),
        replace(DARK, light=1.3),
        replace(DARK, beyond=0.9),
        replace(DARK, images=4),
        Likeness(0, float("nan"), float("nan"), ()),
    ],
)
def test_nothing_is_asked_in_other_runs(likeness):
    found, greys = answer_of(likeness)
    assert found.label == "mud"
    assert greys == [40]


@pytest.mark.parametrize(
    ("others", "label"),
    [(["mud", "mud"], "mud"), (["mud", "snow"], "unknown"), (["snow"], "unknown")],
)
def test_a_name_has_to_stand_by_a_factor_and_by_a_power(others, label):
    shown, mixed = [], np.repeat(np.array([[40], [80]], np.uint8), 8, axis=1)

    class Says:
        def classify(self, images):
            shown.append(images[0][:, 0].tolist())
            return [named("", float(others[len(shown) - 1] == "mud"))]

    (found,) = unless_by_light(Says(), [mixed], [named("mud", 1.0)], DARK)
    assert found.label == label
    # the mean of 60 becomes 150
    power = np.log(150 / 255) / np.log(60 / 255)
    expected = [[100, 200], np.rint(255 * (np.array([40, 80]) / 255) ** power).tolist()]
    assert shown == expected[: len(others)]


def test_nothing_gets_a_name_by_another_light():
    unknown = replace(named("mud", 1.0), label="unknown")
    found, greys = answer_of(DARK, answer=unknown)
    assert found == unknown
    assert greys == []
