"""Whether red, green and blue of a run's images are in another order than in training.

How channels vary together says so in any light. A light is a factor of each channel, and leaves
the covariance of channels over their means as it is. Within photographs colours differ most
between blue and yellow (light and shade, soil and leaves), and much less between green and
magenta; in another order of the channels it is otherwise.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.special import softmax

from odometry.arrays import AnyArray, ByteImage, FloatArray, IntArray
from terrain.classification.likeness.altered_odds import AlteredOdds
from terrain.classification.likeness.chroma import GRIDS, unclipped
from terrain.classification.likeness.nearly_grey import compressed
from terrain.classification.likeness.run_limits import drawn_runs, rows_of_photographs
from terrain.classification.neighbours.validation import grouped_folds
from terrain.classification.photographs.other_light import in_another_white_balance
from terrain.classification.photographs.trained_on import image_sum

# As in training, then all others. Hue turned by 120 degrees is one of them; by 60 degrees, or with
# planes of chroma exchanged, it is near to one.
ORDERS = ((0, 1, 2), (2, 1, 0), (1, 2, 0), (2, 0, 1), (1, 0, 2), (0, 2, 1))
QUALITIES = (50, 75, 90)  # of JPEG: compression blurs colours
DARK = 0.5  # greys, added to a mean: nothing is divided by zero
SMALL = 0.005  # of a channel, as a deviation: what rounding makes
# rows: brightness, blue to yellow (red less blue), magenta to green
AXES = np.array([[1 / 3, 1 / 3, 1 / 3], [1.0, 0.0, -1.0], [-0.5, 1.0, -0.5]])
TURNED_NUMBERS = 6 * len(GRIDS)
LEAST_LIMIT = 0.2  # lights that were not drawn bring some runs of grey terrain beyond 0.1


def covariances_of(image: ByteImage) -> FloatArray:
    """Covariances of red, green and blue, each over its mean, of an image (H, W, 3), (3, 3, 3).

    Of all pixels, and of the means of 24 and of 8 squares a side.
    """
    return np.array([_relative_covariance(pixels) for pixels in unclipped(image)])


def _relative_covariance(pixels: AnyArray) -> FloatArray:
    """Of pixels (n, 3), (3, 3)."""
    mean = pixels.mean(axis=0, dtype=np.float64)
    relative = (pixels - mean) / (mean + DARK)
    return np.asarray(relative.T @ relative / len(relative))


def orders_of(covariances: FloatArray) -> FloatArray:
    """Eighteen numbers of such covariances in each of `ORDERS`, (6, 18).

    Of each grid the logarithm of the deviation of brightness, those of both colour axes less it,
    and the three correlations.
    """
    orders = np.array(ORDERS)
    ordered = covariances[:, orders[:, :, None], orders[:, None, :]]  # grids, orders, 3, 3
    along = AXES @ ordered @ AXES.T
    deviations = np.sqrt(np.maximum(np.diagonal(along, axis1=2, axis2=3), 0)) + SMALL
    bright, yellow, green = np.moveaxis(np.log(deviations), 2, 0)
    related = along / (deviations[..., :, None] * deviations[..., None, :])
    correlations = [related[..., 0, 1], related[..., 0, 2], related[..., 1, 2]]
    numbers = np.array([bright, yellow - bright, green - bright, *correlations])
    return np.asarray(numbers.transpose(2, 1, 0).reshape(len(ORDERS), -1))


@dataclass(frozen=True)
class TurnedChannels:
    """How much more probable each other order of the channels is, and the limits of a run.

    Single images cannot be told: grey ones are alike in any order, and some terrain is as another
    in another order. Of several images the mean decides.

    Attributes
    ----------
    odds : AlteredOdds
        That an order is another one, by the eighteen numbers of `orders_of`.
    limits : FloatArray, shape (5,)
        Of the mean of `beyond_own` of a run: all of 200 runs of three training photographs of
        each terrain keep them, as they are and in another white balance, where each was judged by
        the others.
    """

    odds: AlteredOdds
    limits: FloatArray

    @classmethod
    def of(cls, patches: Sequence[ByteImage], codes: IntArray, groups: AnyArray) -> Self:
        """Of colour patches with terrains (n,) and photographs (n,), at least two of each."""
        shown = np.array([_shown(patch) for patch in patches])  # n, 2, orders, numbers
        held_out = np.zeros((len(shown), shown.shape[1], len(ORDERS) - 1))
        for train, test in grouped_folds(codes, groups):
            judged = cls(_learned(shown[train]), np.ones(len(ORDERS) - 1))
            held_out[test] = [[judged.beyond_own(of) for of in both] for both in shown[test]]
        photos = rows_of_photographs(codes, groups)
        runs = drawn_runs(photos, np.array([codes[rows[0]] for rows in photos]))
        means = np.concatenate([held_out[run].mean(axis=0) for run in runs])
        return cls(_learned(shown), np.maximum(means.max(axis=0), LEAST_LIMIT))

    def beyond_own(self, numbers: FloatArray) -> FloatArray:
        """Probability of each other order of `orders_of` less that of training, (5,)."""
        probabilities = softmax(-self.odds.of(numbers))
        return np.asarray(probabilities[1:] - probabilities[0])

    def measures(self, parts: Sequence[ByteImage]) -> FloatArray:
        """Of an image, the mean of its parts (H, W, 3), over the limits, (5,)."""
        found = [self.beyond_own(orders_of(covariances_of(part))) for part in parts]
        return np.asarray(np.mean(found, axis=0) / self.limits)

    def arrays(self) -> dict[str, AnyArray]:
        """Everything learned, by name."""
        return {
            "turned_scales": self.odds.scales,
            "turned_weights": self.odds.weights,
            "turned_limits": self.limits,
        }

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, AnyArray]) -> Self | None:
        """Rebuild from what `arrays` gave; None of files before version 0.45.

        Raises
        ------
        KeyError, ValueError
            If the arrays do not fit.
        """
        if "turned_scales" not in arrays:
            return None
        odds = AlteredOdds(arrays["turned_scales"], arrays["turned_weights"])
        limits = arrays["turned_limits"]
        if not odds.fits(TURNED_NUMBERS) or limits.shape != (len(ORDERS) - 1,):
            raise ValueError(f"turned channels of shapes {odds.scales.shape}, {limits.shape}")
        return cls(odds, limits)


def _shown(patch: ByteImage) -> FloatArray:
    """Numbers (2, 6, 18) of a patch as it is, and in another white balance and compressed."""
    quality = QUALITIES[int(image_sum(patch), 16) % len(QUALITIES)]
    relit = compressed(in_another_white_balance(patch), quality)
    return np.array([orders_of(covariances_of(image)) for image in (patch, relit)])


def _learned(shown: FloatArray) -> AlteredOdds:
    """From numbers (n, 2, 6, 18)."""
    altered = shown[:, :, 1:].reshape(len(shown), -1, TURNED_NUMBERS)
    return AlteredOdds.learned(shown[:, :, 0], altered)
