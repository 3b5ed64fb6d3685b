"""Whether images of another camera would be noticed: photographs of one camera, and of many."""

import cv2
import numpy as np
import pytest

from terrain.classification.likeness.noticed_alterations import (
    LEAST_NOTICED,
    noticed_share,
    unnoticed,
)
from terrain.classification.likeness.training_look import TrainingLook

PHOTOS, SIZE = 12, 64


def photograph(rng, grain_px, *, light=1.0, blur_px=0.0, noise=0.0):
    """Terrain of a grain, as a camera shows it."""
    grey = cv2.GaussianBlur(rng.normal(0.0, 1.0, (SIZE, SIZE)), (0, 0), grain_px)
    grey = 110 + 30 * grey / grey.std()
    if blur_px:
        grey = cv2.GaussianBlur(grey, (0, 0), blur_px)
    return np.clip(light * grey + rng.normal(0, 1 + noise, grey.shape), 0, 255).astype(np.uint8)


def share_of(cameras, *, photos=PHOTOS):
    """Of two terrains, each photograph by a camera of `cameras(rng)`."""
    rng = np.random.default_rng(3)
    patches = [
        photograph(rng, grain_px, **cameras(rng)) for grain_px in (1.0, 3.0) for _ in range(photos)
    ]
    codes = np.repeat([0, 1], photos)
    groups = np.arange(2 * photos)
    return noticed_share(TrainingLook.of(patches, codes, groups), patches, codes, groups)


def many(rng):
    return {
        "light": rng.uniform(0.4, 1.6),
        "blur_px": rng.uniform(0.0, 2.5),
        "noise": rng.uniform(0.0, 16.0),
    }


def test_alterations_of_one_camera_are_noticed():
    share = share_of(lambda _: {})
    assert share == 1.0
    assert unnoticed(share) is None


def test_among_photographs_of_many_cameras_another_one_may_pass():
    share = share_of(many)
    assert share < LEAST_NOTICED
    assert f"{100 * share:.0f} % of them are noticed" in unnoticed(share)


def test_of_few_photographs_it_is_not_known():
    assert share_of(many, photos=4) is None
    assert unnoticed(None) is None


@pytest.mark.parametrize("share", [LEAST_NOTICED, 1.0])
def test_nothing_is_said_where_it_is_noticed(share):
    assert unnoticed(share) is None
