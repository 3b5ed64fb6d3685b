"""Whether the colours of images are those of the training photographs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Self

import cv2
import numpy as np
from scipy.spatial.distance import cdist

from odometry.arrays import AnyArray, ByteImage, FloatArray, IntArray
from terrain.classification.likeness.likeness import FEWEST_IMAGES, Likeness
from terrain.classification.likeness.look import spread_patches
from terrain.classification.likeness.nearly_grey import NearlyGrey
from terrain.classification.likeness.run_limits import drawn_runs, rows_of_photographs
from terrain.classification.likeness.turned_channels import ORDERS, TurnedChannels

COLOUR_FALSE_ALARMS = 0.01  # share of runs over one known terrain beyond the limit
WHITE_SHARE = 0.01  # of white, added to each mean: black has no logarithm
# Between the channels of a grey image that was stored in three; those of a camera vary by more.
COLOURLESS_GREYS = 2
# Of 180 runs of photographs held out (ground/ and pavements/) one or two are so much nearer to
# training with red and blue exchanged. A light that is bluer by a quarter is, too.
EXCHANGED_RATIO, EXCHANGED_LEAST = 0.5, 0.05


def is_colourless(image: ByteImage) -> bool:
    """Whether an image (H, W, 3) is a grey one in three channels."""
    channels = cv2.split(image)
    spread = np.maximum.reduce(channels) - np.minimum.reduce(channels)
    return bool(spread.max() <= COLOURLESS_GREYS)


def colours_of(image: ByteImage) -> FloatArray:
    """Logarithms of mean red and of mean blue over mean green, (2,), of an image (H, W, 3)."""
    red, green, blue = np.log(image.reshape(-1, 3).mean(axis=0) / 255 + WHITE_SHARE).tolist()
    return np.array([red - green, blue - green])


@dataclass(frozen=True)
class ColourRange:
    """The colours of training patches, and how far runs of held-out photographs are from them.

    Attributes
    ----------
    colours : FloatArray, shape (n, 2)
        Logarithms of mean red and of mean blue over mean green.
    limit : float
        Of the mean distance of a run's images to the nearest patch of other photographs: all but
        one of a hundred runs of three training photographs of one terrain keep it.
    knows_grey : bool
        Whether some patches of every terrain are grey images in three channels.
    nearly_grey : NearlyGrey or None
        None of files before version 0.37.
    turned : TurnedChannels or None
        None of files before version 0.45.
    """

    colours: FloatArray
    limit: float
    knows_grey: bool = False
    nearly_grey: NearlyGrey | None = None
    turned: TurnedChannels | None = None

    @classmethod
    def of(cls, patches: Sequence[ByteImage], codes: IntArray, groups: AnyArray) -> Self:
        """Of colour patches with terrains (n,) and photographs (n,), at least two of these."""
        patches, codes, groups = spread_patches(patches, codes, groups)
        colours = np.array([colours_of(patch) for patch in patches])
        apart = cdist(colours, colours)
        apart[groups[:, None] == groups] = np.inf
        nearest = apart.min(axis=1)
        photos = rows_of_photographs(codes, groups)
        runs = drawn_runs(photos, np.array([codes[rows[0]] for rows in photos]))
        means = [nearest[run].mean() for run in runs]
        limit = float(max(np.quantile(means, 1 - COLOUR_FALSE_ALARMS), 1e-9))
        grey = codes[[is_colourless(patch) for patch in patches]]
        knows_grey = set(grey.tolist()) == set(codes.tolist())
        shown = patches, codes, groups
        return cls(colours, limit, knows_grey, NearlyGrey.of(*shown), TurnedChannels.of(*shown))

    def distances(self, colours: FloatArray) -> FloatArray:
        """Of colours (m, 2) to the nearest training patch: as they are, red and blue exchanged."""
        both = (colours, colours[:, ::-1])
        return np.column_stack([cdist(of, self.colours).min(axis=1) for of in both])

    def measures(self, parts: Sequence[ByteImage]) -> FloatArray:
        """Of an image, by its parts (H, W, 3), (8,).

        `distances`, how probably it is grey, and `TurnedChannels.measures`.
        """
        colours = np.mean([colours_of(part) for part in parts], axis=0)
        grey = 0.0 if self.nearly_grey is None else self.nearly_grey.probability(parts)
        turned = np.zeros(len(ORDERS) - 1) if self.turned is None else self.turned.measures(parts)
        return np.array([*self.distances(colours[None])[0], grey, *turned])

    def compared(self, likeness: Likeness, measures: FloatArray) -> Likeness:
        """A likeness with what `measures` (m, 8) of its images say; few images say nothing."""
        if len(measures) < FEWEST_IMAGES:
            return likeness
        as_they_are, exchanged, grey, *turned = measures.mean(axis=0).tolist()
        is_less = exchanged < EXCHANGED_RATIO * as_they_are
        return replace(
            likeness,
            colour_beyond=as_they_are / self.limit,
            exchanged=is_less and as_they_are - exchanged > EXCHANGED_LEAST,
            grey_beyond=0.0 if self.nearly_grey is None else grey / self.nearly_grey.limit,
            turned_beyond=max(0.0, *turned),
        )

    def arrays(self) -> dict[str, AnyArray]:
        """Everything learned, by name."""
        numbers = np.array([self.limit, self.knows_grey])
        of_signs: dict[str, AnyArray] = {}
        for sign in (self.nearly_grey, self.turned):
            of_signs |= {} if sign is None else sign.arrays()
        return {"colour_points": self.colours, "colour_numbers": numbers} | of_signs

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, AnyArray]) -> Self | None:
        """Rebuild from what `arrays` gave; None of grey models and files before version 0.36.

        Raises
        ------
        KeyError, ValueError
            If the arrays do not fit.
        """
        if "colour_points" not in arrays:
            return None
        colours, numbers = arrays["colour_points"], arrays["colour_numbers"]
        if colours.ndim != 2 or colours.shape[1] != 2 or not len(colours) or numbers.shape != (2,):
            raise ValueError(f"colours of shapes {colours.shape}, {numbers.shape}")
        signs = NearlyGrey.from_arrays(arrays), TurnedChannels.from_arrays(arrays)
        return cls(colours, float(numbers[0]), bool(numbers[1]), *signs)
