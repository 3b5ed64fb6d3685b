"""Terrains whose photographs alone are less sharp, or noisier."""

import cv2
import numpy as np
import pytest

from terrain.classification.photographs.finest_detail import (
    LESS_SHARP,
    NOISIER,
    SHORTEST_PX,
    apart,
    kink,
    set_apart_by_pixels,
    spectrum,
)
from terrain.classification.photographs.photo_origins import FEWEST

SIDE = 128
SLOPES = {"gravel": 1.5, "mud": 2.5, "sand": 2.0}  # of the logarithm of power: terrains differ


def surface(rng, slope):
    """A texture whose power falls with frequency, as a camera with little noise shows it."""
    frequency = np.hypot(np.fft.fftfreq(SIDE)[:, None], np.fft.rfftfreq(SIDE))
    frequency[0, 0] = np.inf
    waves = np.fft.rfft2(rng.normal(size=(SIDE, SIDE))) * frequency ** (-slope / 2)
    texture = np.fft.irfft2(waves, s=(SIDE, SIDE))
    image = 128 + 12 * texture / texture.std() + rng.normal(scale=1.0, size=texture.shape)
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)


def blurred(image, _rng):
    return cv2.GaussianBlur(image, (0, 0), 1.5)


def enlarged(image, _rng):
    half = cv2.resize(image, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
    return cv2.resize(half, (SIDE, SIDE), interpolation=cv2.INTER_CUBIC)


def noisy(image, rng):
    noise = rng.normal(scale=14.0, size=image.shape)
    return np.clip(np.rint(image + noise), 0, 255).astype(np.uint8)


def spectra(rng, terrains, alter=None, altered=(), photos=FEWEST):
    found = {}
    for terrain in terrains:
        images = [surface(rng, SLOPES[terrain]) for _ in range(photos)]
        if terrain in altered:
            images = [alter(image, rng) for image in images]
        found[terrain] = np.array([spectrum(image) for image in images])
    return found


@pytest.mark.parametrize(
    ("alter", "how"), [(blurred, LESS_SHARP), (enlarged, LESS_SHARP), (noisy, NOISIER)]
)
def test_one_terrain_by_another_camera(rng, alter, how):
    assert apart(spectra(rng, SLOPES)) == {}
    assert apart(spectra(rng, SLOPES, alter, {"mud"})) == {"mud": how}
    assert apart(spectra(rng, ("sand", "mud"), alter, {"mud"})) == {"mud": how}


@pytest.mark.parametrize("alter", [blurred, enlarged, noisy])
def test_what_all_or_two_terrains_share_sets_none_apart(rng, alter):
    assert apart(spectra(rng, SLOPES, alter, SLOPES)) == {}
    assert apart(spectra(rng, SLOPES, alter, {"mud", "sand"})) == {}


def test_few_photographs_tell_nothing(rng):
    assert apart(spectra(rng, SLOPES, blurred, {"mud"}, photos=FEWEST - 1)) == {}


def test_a_third_of_the_photographs_is_not_most(rng):
    found = spectra(rng, SLOPES, photos=9)
    blurry = spectra(rng, SLOPES, blurred, {"mud"}, photos=9)["mud"]
    found["mud"] = np.concatenate([found["mud"][:3], blurry[:6]])
    assert apart(found) == {}
    found["mud"] = np.concatenate([found["mud"][:1], blurry[:8]])
    assert apart(found) == {"mud": LESS_SHARP}


def test_a_smooth_surface_in_noise_is_no_blur(rng):
    found = spectra(rng, SLOPES)
    smooth = [noisy(cv2.GaussianBlur(surface(rng, 2.0), (0, 0), 4.0), rng) for _ in range(FEWEST)]
    found["snow"] = np.array([spectrum(image) for image in smooth])
    assert "snow" not in {t for t, how in apart(found).items() if how == LESS_SHARP}


def test_a_spectrum_that_falls_evenly_has_no_kink():
    assert kink(np.linspace(6, 0, 7)[None]) == pytest.approx(0, abs=1e-9)
    ends = np.array([[6.0, 5, 4, 3, 0, -2, -2]])
    assert kink(ends) == pytest.approx(2.0)


def made(bends, finest, floor=0.0):
    """Spectra of five photographs that fall by one a band, with these bends at five bands."""
    falls = -1.0 + np.concatenate([[0.0], np.cumsum(bends)])
    of_all = np.concatenate([[0.0], np.cumsum(falls)])
    least_textured = floor + np.linspace(0.6, 0.0, 7)
    return np.tile(np.stack([of_all - of_all[-1] + finest, least_textured]), (FEWEST, 1, 1))


EVEN, ENDS, ENDS_COARSELY = (0.0,) * 5, (0, 0, 0, 1.5, 0), (0.0, 1.5, 0, 0, 0)


@pytest.mark.parametrize(
    ("own", "others", "found"),
    [
        (made(ENDS, -1.0), made(EVEN, -1.0), LESS_SHARP),
        (made(ENDS, 1.5), made(EVEN, -1.0), None),  # noise or detail is left
        (made(ENDS, -1.0), made((0, 0, 0, 1.0, 0), -1.0), None),  # they end as well
        (made((0, 0, 0, 0.9, 0), -1.0), made((0, 0, 0, 0.75, 0), -1.0), None),  # not far apart
        (made((1.5, 0, 0, 0, 0), -1.0), made(EVEN, -1.0), None),
        (made(ENDS_COARSELY, -1.0), made(EVEN, -1.0), None),
        (made(ENDS, -1.0), made(ENDS_COARSELY, -1.0), None),
        (made(EVEN, 3.0, floor=3.0), made(EVEN, 3.0, floor=1.0), NOISIER),
        (made(EVEN, 3.0, floor=3.0), made(EVEN, 3.0, floor=1.8), None),
        (made(EVEN, 1.0, floor=1.0), made(EVEN, -1.0, floor=-1.0), None),  # hardly noise
    ],
)
def test_each_limit(own, others, found):
    expected = {} if found is None else {"mud": found}
    assert apart({"mud": own, "sand": others}) == expected


def test_power_is_that_of_noise(rng):
    noise = np.clip(np.rint(rng.normal(128, 10, (300, 300))), 0, 255).astype(np.uint8)
    of_all, least_textured = spectrum(noise)
    np.testing.assert_allclose(of_all, np.log(100), atol=0.1)
    assert least_textured[-1] == pytest.approx(np.log(100), abs=0.1)


def test_files_are_read_and_small_or_broken_ones_left_out(tmp_path, rng):
    label_of = {}
    for terrain, slope in SLOPES.items():
        for photo in range(FEWEST):
            image = surface(rng, slope)
            path = tmp_path / f"{terrain}{photo}.png"
            cv2.imwrite(str(path), blurred(image, rng) if terrain == "sand" else image)
            label_of[path] = terrain
    for name, image in {"small": surface(rng, 2.0)[: SHORTEST_PX - 1], "broken": None}.items():
        path = tmp_path / f"{name}.png"
        path.write_bytes(b"no image") if image is None else cv2.imwrite(str(path), image)
        label_of[path] = "sand"
    assert set_apart_by_pixels(label_of) == {"sand": LESS_SHARP}
    assert set_apart_by_pixels({tmp_path / "broken.png": "sand"}) == {}
