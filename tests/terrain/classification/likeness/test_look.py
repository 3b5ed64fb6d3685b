"""The seven numbers of a look, against their definition by SciPy's Gaussians."""

import itertools

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from terrain.classification.likeness.look import SIGMAS_PX, look_of


@pytest.fixture
def patch():
    """Waves and noise (96, 96), as grey bytes."""
    rng = np.random.default_rng(3)
    row, column = np.mgrid[:96, :96]
    waves = 40 * np.sin(row / 3) + 25 * np.sin((row + column) / 11)
    return np.clip(120 + waves + rng.normal(0, 12, (96, 96)), 0, 255).astype(np.uint8)


def defined(patch):
    """The look of a grey patch in float64, each Gaussian at full scale."""
    grey = patch.astype(float)
    levels = [grey, *(gaussian_filter(grey, s, mode="mirror", truncate=6) for s in SIGMAS_PX)]
    octaves = [finer - coarser for finer, coarser in itertools.pairwise(levels)]
    spreads = np.log([octave.var() + 0.05 for octave in octaves])
    finest = np.abs(octaves[0])
    usual = np.log((np.median(finest) + 0.1) / (np.sqrt(np.mean(finest**2)) + 0.1))
    return np.array(
        [grey.mean() / 255, np.log(grey.std() + 1), *(spreads[:-1] - spreads[1:]), usual]
    )


def test_a_look_is_what_its_definition_says(patch):
    assert look_of(patch) == pytest.approx(defined(patch), abs=0.02)


def test_most_places_of_a_compressed_patch_have_no_finest_octave(patch):
    blocks = np.repeat(np.repeat(patch[::8, ::8], 8, axis=0), 8, axis=1)
    assert look_of(blocks)[6] < look_of(patch)[6] - 1
