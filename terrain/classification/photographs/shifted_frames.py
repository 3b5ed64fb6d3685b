"""Photographs that show the scene of the one before, shifted: frames of a burst or a video."""

from collections.abc import Iterator, Mapping
from itertools import groupby
from pathlib import Path

import cv2
import numpy as np
from scipy import fft

from odometry.arrays import AnyArray, FloatArray

SIDE_PX = 128
NEXT = 5  # photographs of a folder, in order of their names, with which each is compared
BAND = (2.0, 32.0)  # waves across the image: neither shade nor noise and compression
PEAK = 25.0  # standard deviations; of 10891 pairs of other scenes in development 24 at most
_ROWS, _COLUMNS = fft.fftfreq(SIDE_PX, 1 / SIDE_PX), fft.rfftfreq(SIDE_PX, 1 / SIDE_PX)
_WAVES = np.hypot(_ROWS[:, None], _COLUMNS)
_IN_BAND = (_WAVES - BAND[0]) * (BAND[1] - _WAVES) > 0
_WINDOW = np.outer(np.hanning(SIDE_PX), np.hanning(SIDE_PX))


def shifted_frames(group_of: Mapping[Path, str]) -> Iterator[tuple[Path, Path]]:
    """Photographs with one of another group shortly after that shows the same.

    In order of their names, within each folder and of all folders together: a burst may have been
    put to two terrains. By phase correlation: shifts of up to a tenth of the image and small turns
    do not hide a scene. Photographs that are not read are like none.
    """
    by_folder = [list(of) for _, of in groupby(sorted(group_of), key=lambda photo: photo.parent)]
    together = [sorted(group_of, key=lambda photo: (photo.name, photo))]
    for photos in by_folder + (together if len(by_folder) > 1 else []):
        before: list[tuple[Path, AnyArray]] = []
        for photo in photos:
            phases = _phases(photo)
            for other, of_other in before:
                if group_of[other] != group_of[photo] and peak(phases, of_other) > PEAK:
                    yield other, photo
            before = [*before[1 - NEXT :], (photo, phases)]


def peak(phases: AnyArray, other: AnyArray) -> float:
    """Height of the peak of the phase correlation in standard deviations of all shifts."""
    correlation: FloatArray = fft.irfft2(phases * np.conj(other), s=(SIDE_PX, SIDE_PX))
    spread = float(correlation.std())
    return float(correlation.max()) / spread if spread > 0 else 0.0


def _phases(photo: Path) -> AnyArray:
    """Waves of length one of an image of `SIDE_PX`; zero outside the band, and of a flat image."""
    image = cv2.imread(str(photo), cv2.IMREAD_REDUCED_GRAYSCALE_2)
    if image is None:
        return np.zeros_like(_IN_BAND, dtype=complex)
    grey = cv2.resize(image, (SIDE_PX, SIDE_PX), interpolation=cv2.INTER_AREA).astype(np.float64)
    waves = fft.rfft2((grey - grey.mean()) * _WINDOW)
    lengths = np.abs(waves)
    least = 1e-3 * lengths.max()  # below, a wave counts less
    return np.where(_IN_BAND, waves / np.maximum(lengths, max(least, 1e-9)), 0.0)
