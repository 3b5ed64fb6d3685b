import numpy as np
import pytest

from terrain.classification.neighbours.rejection import (
    PATCHES,
    as_of_one_patch,
    rejection_distances,
)


def test_one_patch_is_judged_by_the_quantile_of_all(rng):
    distances = rng.exponential(size=400)
    limits = rejection_distances(distances, np.repeat(np.arange(20), 20), 0.1)
    assert limits[0] == np.quantile(distances, 0.9)
    assert list(limits) == sorted(limits, reverse=True)


def test_the_share_of_held_out_photographs_beyond_is_the_one_requested(rng):
    """Independent photographs of 16 patches: the median of 16 is beyond in 5 %."""
    members = np.repeat(np.arange(2000), 16)
    level = rng.normal(0, 0.3, 2000)[members]
    limits = rejection_distances(level + rng.normal(3, 1, len(members)), members, 0.05)
    fresh = rng.normal(0, 0.3, 4000)[:, None] + rng.normal(3, 1, (4000, 16))
    for count, limit in zip(PATCHES, limits, strict=True):
        assert np.mean(np.median(fresh[:, :count], axis=1) > limit) == pytest.approx(0.05, abs=0.02)


def test_photographs_of_one_patch_have_one_limit(rng):
    limits = rejection_distances(rng.exponential(size=50), np.arange(50), 0.05)
    assert set(limits) == {limits[0]}


@pytest.mark.parametrize("patches", [1, 2, 3, 8, 16, 40])
def test_the_scale_of_one_patch_keeps_the_decision(patches):
    limits = (10.0, 9.0, 7.0, 5.0, 4.0)
    limit = np.interp(np.log(patches), np.log(PATCHES), limits)
    assert as_of_one_patch(limit, patches, limits) == pytest.approx(10.0)
    assert as_of_one_patch(2.0, patches, (10.0,)) == 2.0  # one limit for all
    assert as_of_one_patch(0.0, patches, (0.0,) * 5) == 0.0
