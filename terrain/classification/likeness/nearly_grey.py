"""Whether the images of a run are nearly grey: grey with a tint, or with hardly any colour."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import cv2
import numpy as np
from scipy.special import expit

from odometry.arrays import AnyArray, ByteImage, FloatArray, IntArray
from terrain.classification.likeness.altered_odds import AlteredOdds
from terrain.classification.likeness.chroma import CHROMA_NUMBERS, chroma_of
from terrain.classification.likeness.run_limits import drawn_runs, rows_of_photographs
from terrain.classification.neighbours.validation import grouped_folds
from terrain.images import to_grey

# Red, green and blue of grey 1: warm, cool, and sepia; shares of the saturation that are left
TINTS = ((1.0, 0.98, 0.93), (0.93, 0.97, 1.0), (1.351, 1.203, 0.937))
SATURATIONS = (0.1, 0.2, 0.3)
CHANGES = len(TINTS) + len(SATURATIONS)
EACH, STEP = 3, 2  # changed copies of a patch, each by the next change but one
JPEG_QUALITY = 90  # of copies: compression rounds colours
FALSE_ALARMS = 0.01  # share of runs over one known terrain beyond the limit


def made_grey(patch: ByteImage, change: int) -> ByteImage:
    """A patch (S, S, 3) with one of `CHANGES`: grey times a tint, or with less saturation."""
    grey = to_grey(patch)[..., None].astype(np.float64)
    if change < len(TINTS):
        changed = grey * np.array(TINTS[change])
    else:
        changed = grey + SATURATIONS[change - len(TINTS)] * (patch - grey)
    return compressed(np.clip(np.rint(changed), 0, 255).astype(np.uint8), JPEG_QUALITY)


def compressed(image: ByteImage, quality: int) -> ByteImage:
    """An image (H, W, 3) as a JPEG of a quality stores it."""
    _, data = cv2.imencode(".jpg", image[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, quality])
    return np.asarray(cv2.imdecode(data, cv2.IMREAD_COLOR), np.uint8)[..., ::-1]


@dataclass(frozen=True)
class NearlyGrey:
    """How probably a patch is one of training that was made nearly grey, and the limit of a run.

    Single images cannot be told apart: some terrain is grey by nature, and so are some photographs.
    Of several the mean decides, which no single one determines.

    Attributes
    ----------
    odds : AlteredOdds
        By the nine numbers of `chroma_of`.
    limit : float
        Of the mean probability of a run: all but one of a hundred runs of three training
        photographs of one terrain keep it, where each was judged by the others.
    """

    odds: AlteredOdds
    limit: float

    @classmethod
    def of(cls, patches: Sequence[ByteImage], codes: IntArray, groups: AnyArray) -> Self:
        """Of colour patches with terrains (n,) and photographs (n,), at least two of each."""
        own = np.array([chroma_of(patch) for patch in patches])
        changed = np.array([_copies(patch, i) for i, patch in enumerate(patches)])
        held_out = np.zeros(len(own))
        for train, test in grouped_folds(codes, groups):
            odds = AlteredOdds.learned(own[train, None], changed[train])
            held_out[test] = expit(odds.of(own[test]))
        photos = rows_of_photographs(codes, groups)
        runs = drawn_runs(photos, np.array([codes[rows[0]] for rows in photos]))
        limit = np.quantile([held_out[run].mean() for run in runs], 1 - FALSE_ALARMS)
        return cls(AlteredOdds.learned(own[:, None], changed), float(max(limit, 1e-9)))

    def probability(self, parts: Sequence[ByteImage]) -> float:
        """Of an image, the mean of its parts (H, W, 3)."""
        return float(expit(self.odds.of(np.array([chroma_of(part) for part in parts]))).mean())

    def arrays(self) -> dict[str, AnyArray]:
        """Everything learned, by name."""
        weights = np.array([*self.odds.weights, self.limit])
        return {"grey_scales": self.odds.scales, "grey_weights": weights}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, AnyArray]) -> Self | None:
        """Rebuild from what `arrays` gave; None of files before version 0.37.

        Raises
        ------
        KeyError, ValueError
            If the arrays do not fit.
        """
        if "grey_scales" not in arrays:
            return None
        scales, numbers = arrays["grey_scales"], arrays["grey_weights"]
        odds = AlteredOdds(scales, numbers[:-1])
        if not odds.fits(CHROMA_NUMBERS):
            raise ValueError(f"nearly grey images of shapes {scales.shape}, {numbers.shape}")
        return cls(odds, float(numbers[-1]))


def _copies(patch: ByteImage, number: int) -> list[FloatArray]:
    kinds = [(number + k * STEP) % CHANGES for k in range(EACH)]
    return [chroma_of(made_grey(patch, kind)) for kind in kinds]
