"""The paper's decision: the middle patch, and always a name."""

import numpy as np
import pytest

from terrain.classification.classifier import TerrainClassifier
from terrain.errors import ImageError
from terrain.run_presets import OnePatchClassifier


@pytest.fixture(scope="module")
def paper(training_patches):
    return TerrainClassifier("chen2023", metres_per_pixel=0.006).fit(*training_patches)


def test_only_the_middle_patch_is_asked(paper, training_patches):
    """A patch keeps its answer whatever is round it."""
    one = OnePatchClassifier(paper)
    size = paper.patch_size_px
    for patch in training_patches[0][::7]:
        framed = np.random.default_rng(0).integers(0, 256, (size + 11, size + 24), dtype=np.uint8)
        framed[5 : 5 + size, 12 : 12 + size] = patch
        (inner,), (outer,) = one.classify([patch]), one.classify([framed])
        assert (inner.label, inner.probabilities) == (outer.label, outer.probabilities)


def test_there_is_always_a_name(paper):
    """Ground unlike any of the training is refused by the classifier itself."""
    stripes = np.zeros((32, 32), np.uint8)
    stripes[:, ::9] = 255
    black = [stripes, np.full((32, 32), 255, np.uint8)]
    assert "unknown" in [answer.label for answer in paper.classify(black)]
    for answer in OnePatchClassifier(paper).classify(black):
        assert answer.label == max(answer.probabilities, key=answer.probabilities.get)


def test_an_image_smaller_than_a_patch_is_an_error(paper):
    with pytest.raises(ImageError, match="smaller"):
        OnePatchClassifier(paper).classify([np.zeros((20, 40), np.uint8)])
