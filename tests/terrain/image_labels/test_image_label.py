"""What the label of an image says of the terrain."""

import pytest

from terrain.classification.answer import DOUBTFUL, IMPROBABLE, UNNOTICED, Classification
from terrain.classification.no_ground import DARK, OVEREXPOSED, SMOOTH
from terrain.classification.training_light import BY_LIGHT
from terrain.image_labels.image_label import ImageLabel, answered


@pytest.mark.parametrize("reason", ["", IMPROBABLE, SMOOTH, "the images of the last 2 m together"])
def test_an_image_that_resembles_no_terrain_is_evidence(reason):
    assert ImageLabel(0.0, "", "unknown", reason=reason).is_evidence


@pytest.mark.parametrize("reason", [DOUBTFUL, UNNOTICED, BY_LIGHT, DARK, OVEREXPOSED])
def test_a_doubtful_name_or_an_image_without_grey_is_none(reason):
    assert not ImageLabel(0.0, "", "unknown", reason=reason).is_evidence
    assert ImageLabel(0.0, "", "mud", reason=reason).is_evidence


@pytest.mark.parametrize(("right", "is_evidence"), [("snow", False), ("unknown", True)])
def test_two_names_side_by_side_are_none(right, is_evidence):
    left = "mud" if right == "snow" else "unknown"
    answers = [Classification(name, 0.9, 1.0, {}) for name in (left, right)]
    assert answered(0.0, "", None, answers).is_evidence == is_evidence
