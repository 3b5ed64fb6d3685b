import numpy as np
import pytest
from scipy.linalg import logm

from terrain.classification.features.copies import GREY_COPIES, Copies
from terrain.classification.features.filters import Scales
from terrain.classification.features.joint_statistics import (
    LEFT_OUT,
    chromaticities,
    directions,
    joint_names,
    joint_statistics,
)

ROWS, COLUMNS = np.mgrid[0:96, 0:96].astype(np.float32)


def blotches(rng, shape=(96, 96)):
    """A patch with slopes at several scales."""
    fine, coarse = rng.integers(0, 60, shape), rng.integers(0, 140, (-(-shape[0] // 8), 12))
    return (fine + np.kron(coarse, np.ones((8, 8)))[: shape[0], : shape[1]]).astype(np.uint8)


def statistics_of(grey):
    return joint_statistics(Copies(grey), colour=False)


def test_it_is_the_matrix_logarithm_of_the_covariance_of_the_images(rng):
    grey = blotches(rng, (80, 96))
    scales = Scales(grey)
    images = [of(scales) for name, of in GREY_COPIES.items() if name not in LEFT_OUT]
    images += [image for sigma_px in (0.7, 1.4, 2.8) for image in directions(scales, sigma_px)]
    pixels = np.array([image.ravel() for image in images], float)
    expected = logm(np.cov(pixels, bias=True) + 4 * np.eye(20))
    found = statistics_of(grey)
    assert len(found) == len(joint_names(colour=False)) == 230
    np.testing.assert_allclose(found[:210], expected[np.triu_indices(20)], atol=1e-9)
    np.testing.assert_allclose(found[210:], pixels.mean(axis=1) / 50)


def test_names_stand_at_their_places(rng):
    grey = blotches(rng)
    found = dict(zip(joint_names(colour=False), statistics_of(grey), strict=True))
    assert found["joint_mean_grey"] == pytest.approx(grey.mean() / 50)
    across, _ = directions(Scales(grey), 2.8)
    assert found["joint_mean_along_2.8"] == pytest.approx(across.mean() / 50)
    louder = dict(zip(joint_names(colour=False), statistics_of(grey // 2), strict=True))
    assert louder["joint_grey_grey"] < found["joint_grey_grey"] - 1


def test_a_mirror_changes_signs_of_slanting_directions_alone(rng):
    """Sines of twice the angle turn round; bytes that are rounded the other way move the rest."""
    grey = blotches(rng)
    names = joint_names(colour=False)
    slanting = np.array([name.count("aslant") == 1 for name in names])
    means = np.array([name.startswith("joint_mean") for name in names])
    sign = np.where(slanting, -1, 1)
    before = statistics_of(grey)
    for mirrored in (grey[:, ::-1], grey[::-1]):
        after = statistics_of(np.ascontiguousarray(mirrored))
        np.testing.assert_allclose(after[~means], (sign * before)[~means], atol=2e-4)
        expected = np.where(slanting, 2 * 128 / 50 - before, before)
        np.testing.assert_allclose(after[means], expected[means], atol=2e-4)
    assert np.abs(before[slanting & ~means]).max() > 0.01


@pytest.mark.parametrize(("angle", "along", "aslant"), [(0, 188, 128), (45, 128, 188),
                                                        (90, 68, 128), (135, 128, 68)])  # fmt: skip
def test_directions_are_cosine_and_sine_of_twice_the_angle(angle, along, aslant):
    turn = np.radians(angle)
    ramp = 128 + 1.5 * (np.cos(turn) * (COLUMNS - 48) + np.sin(turn) * (ROWS - 48))
    cosine, sine = directions(Scales(ramp), 1.4)
    assert abs(int(cosine[48, 48]) - along) <= 2  # the gradient's 0.05 takes 1.3 of 60
    assert abs(int(sine[48, 48]) - aslant) <= 2
    for flat in directions(Scales(np.full((9, 9), 70, np.uint8)), 1.4):
        np.testing.assert_array_equal(flat, 128)


def test_chromaticities_by_hand_and_in_shadow():
    image = np.empty((40, 60, 3), np.uint8)
    image[:] = 120, 90, 60
    redness, yellowness, *slow = chromaticities(image)
    np.testing.assert_array_equal(redness, 158)  # 128 + 300 * 30 / 300
    np.testing.assert_array_equal(yellowness, 173)  # 128 + 300 * 45 / 300
    for change in slow:
        np.testing.assert_array_equal(change, 128)
    shadow = chromaticities(image // 2)
    assert abs(int(shadow[0][0, 0]) - 158) <= 3


def test_colour_adds_six_images(rng):
    image = rng.integers(0, 256, (40, 48, 3), dtype=np.uint8)
    found = joint_statistics(Copies(image), colour=True)
    names = joint_names(colour=True)
    assert len(found) == len(names) == len(set(names)) == 377
    assert found[names.index("joint_mean_redness")] == pytest.approx(
        chromaticities(image)[0].mean() / 50
    )
