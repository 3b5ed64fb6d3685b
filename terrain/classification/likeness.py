"""Whether images look like the training photographs: sharpness, scale, exposure, compression."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Self

import cv2
import numpy as np
from scipy.spatial.distance import cdist

from odometry.arrays import AnyArray, ByteImage, FloatArray, IntArray
from terrain.images import to_grey

NUMBERS = 7  # of a look; files before version 0.14 have the first six
TEXTURE = slice(2, 6)
# what it is to be low or high in them
WORDS = (
    ("darker", "brighter"),
    ("of less contrast", "of more contrast"),
    ("more blurred", "sharper or noisier"),
    *[("coarser", "finer")] * 3,  # of all octaves
    ("more compressed", "less compressed"),
)
SIGMAS_PX = (0.7, 1.4, 2.8, 5.6, 11.2)  # between two of them lies an octave of texture
PATCHES_PER_PHOTO = 12
MOST_PATCHES = 2000
NEAREST = 3
SIMILAR = 30  # patches of the most similar texture
FEWEST_IMAGES = 5
# chosen on ground/, pavements/ and frames of other cameras: these are no independent test
UNLIKE_RANK, UNLIKE_RANK_IN_CLASS = 0.75, 0.7
UNLIKE_EXPOSURE = 0.4  # from one half
MOST_WORDS = 3
WORTH_NAMING = 0.5  # deviations within a terrain


@dataclass(frozen=True)
class Likeness:
    """Whether the images of a run, or a folder, look like the training photographs.

    Attributes
    ----------
    images : int
    rank, rank_in_class : float
        Mean share of held-out training patches that are nearer to the other photographs than an
        image is; among all, and among those of the terrain that it is nearest to. 0.5 where the
        images are like the photographs, 1 where none is. NaN without images.
    how : tuple of str
        In what the images differ most.
    exposure : float
        Mean share of the 30 training patches of the most similar texture that are darker: 0.5
        where the light is that of training, 1 where every image is brighter.
    """

    images: int
    rank: float
    rank_in_class: float
    how: tuple[str, ...]
    exposure: float = 0.5

    @classmethod
    def of(cls, ranks: Sequence[tuple[float, float, float]], how: tuple[str, ...] = ()) -> Self:
        """The summary of the `TrainingLook.ranks` of images."""
        if not ranks:
            return cls(0, float("nan"), float("nan"), ())
        rank, in_class, exposure = np.mean(ranks, axis=0).tolist()
        return cls(len(ranks), rank, in_class, how, exposure)

    @property
    def is_unlike(self) -> bool | None:
        """None where there are too few images."""
        if self.images < FEWEST_IMAGES:
            return None
        is_far = self.rank > UNLIKE_RANK and self.rank_in_class > UNLIKE_RANK_IN_CLASS
        return is_far or abs(self.exposure - 0.5) > UNLIKE_EXPOSURE

    @property
    def note(self) -> str | None:
        """A warning where labels are in doubt; else None."""
        if not self.is_unlike:
            return None
        how = f" ({', '.join(self.how)})" if self.how else ""
        return (
            f"the images are unlike the training photographs of the model{how}: another camera, "
            f"distance, light or compression. {100 * self.rank:.0f} % of held-out training patches "
            f"are nearer to the others than these images are, and {100 * self.exposure:.0f} % of "
            "those of similar texture are darker. Many labels may be wrong; label images of this "
            "camera and train with them"
        )


@dataclass(frozen=True)
class TrainingLook:
    """How the training patches look.

    Attributes
    ----------
    looks : FloatArray, shape (n, 7)
    codes : IntArray, shape (n,)
        Terrains.
    distances : FloatArray, shape (n,)
        Of each patch to the nearest of other photographs.
    """

    looks: FloatArray
    codes: IntArray
    distances: FloatArray

    @classmethod
    def of(cls, patches: Sequence[ByteImage], codes: IntArray, groups: AnyArray) -> Self:
        """Of square patches with terrains (n,) and photographs (n,), at least two of each."""
        rows = spread_rows(groups)
        looks, codes, groups = (
            np.array([look_of(patches[i]) for i in rows]),
            codes[rows],
            groups[rows],
        )
        unknown = cls(looks, codes, np.zeros(len(looks)))
        own = groups[:, None] == groups
        return cls(looks, codes, unknown._nearest(looks, own)[0])

    @cached_property
    def spread(self) -> FloatArray:
        """Deviation of each number (7,) within a terrain, not quite zero."""
        means = np.array([self.looks[self.codes == c].mean(axis=0) for c in self.codes])
        return np.asarray(np.maximum((self.looks - means).std(axis=0), 1e-3))

    @cached_property
    def _middle(self) -> FloatArray:
        return np.asarray(np.median(self.looks, axis=0))

    @cached_property
    def _scaled(self) -> FloatArray:
        return self.looks / self.spread

    def compared(self, looks: FloatArray) -> Likeness:
        """Compare the looks (m, 7) of images."""
        ranks = [self.ranks(look) for look in looks]
        return Likeness.of(ranks, self.how(looks) if ranks else ())

    def ranks(self, look: FloatArray) -> tuple[float, float, float]:
        """Share of the training patches nearer than a look (7,): of all, and of its terrain.

        The third is the share that is darker of the patches of the most similar texture.
        """
        (distance,), (nearest,) = self._nearest(look[None])
        nearer = self.distances < distance
        apart = (self.looks[:, TEXTURE] - look[TEXTURE]) / self.spread[TEXTURE]
        similar = np.argsort((apart**2).sum(axis=1), kind="stable")[:SIMILAR]
        return (
            float(nearer.mean()),
            float(nearer[self.codes == self.codes[nearest]].mean()),
            float(np.mean(self.looks[similar, 0] < look[0])),
        )

    def how(self, looks: FloatArray) -> tuple[str, ...]:
        """In what looks (m, 7) of images differ from those in training, most of all first."""
        apart = (np.median(looks, axis=0)[: len(self.spread)] - self._middle) / self.spread
        words: dict[tuple[str, str], str] = {}
        for i in np.argsort(-np.abs(apart)):
            if abs(apart[i]) > WORTH_NAMING:
                words.setdefault(WORDS[i], WORDS[i][int(apart[i] > 0)])
        return tuple(words.values())[:MOST_WORDS]

    def _nearest(
        self, looks: FloatArray, left_out: AnyArray | None = None
    ) -> tuple[FloatArray, IntArray]:
        """Mean distance of looks (m, 7) to the nearest patches, and the nearest of them."""
        apart = cdist(looks[:, : len(self.spread)] / self.spread, self._scaled)
        if left_out is not None:
            apart[left_out] = np.inf
        few = min(NEAREST, apart.shape[1])
        mean = np.sort(np.partition(apart, few - 1, axis=1)[:, :few], axis=1).mean(axis=1)
        return np.where(np.isfinite(mean), mean, 1e9), apart.argmin(axis=1)

    def arrays(self) -> dict[str, AnyArray]:
        """Everything learned, by name."""
        return {
            "look_points": self.looks,
            "look_codes": self.codes,
            "look_distances": self.distances,
        }

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, AnyArray], classes: int) -> Self | None:
        """Rebuild from what `arrays` gave; None of files of version 0.9, which have none.

        Raises
        ------
        KeyError, ValueError
            If the arrays do not fit.
        """
        if "look_points" not in arrays:
            return None
        looks, codes, own = (arrays[f"look_{of}"] for of in ("points", "codes", "distances"))
        fits = looks.ndim == 2 and looks.shape[1] in {NUMBERS - 1, NUMBERS} and len(looks) > 0
        if not fits or codes.shape != own.shape or codes.shape != looks.shape[:1]:
            raise ValueError(f"looks of shapes {looks.shape}, {codes.shape}, {own.shape}")
        if codes.dtype.kind != "i" or not 0 <= codes.min() <= codes.max() < classes:
            raise ValueError(f"codes of looks do not name {classes} classes")
        return cls(looks, codes, own)


def look_of(patch: ByteImage) -> FloatArray:
    """Seven numbers (7,) of a patch: mean grey, contrast, how octaves compare, and compression.

    The mean is in units of white, the others are natural logarithms: of the deviation of grey, of
    the variance of an octave over that of the next coarser one, finest first, and of the median
    size of the finest octave over its deviation, which compression sets to zero in most places.
    """
    grey = to_grey(patch).astype(np.float32)
    levels = [grey, *(cv2.GaussianBlur(grey, (0, 0), sigma) for sigma in SIGMAS_PX)]
    octaves = np.log([float(np.var(a - b)) + 0.05 for a, b in pairwise(levels)])
    finest = np.abs(grey - levels[1])
    usual = np.log((np.median(finest) + 0.1) / (np.sqrt(np.mean(finest**2)) + 0.1))
    exposure = [grey.mean() / 255, np.log(grey.std() + 1)]
    return np.array([*exposure, *(octaves[:-1] - octaves[1:]), usual])


def middle_of(image: ByteImage, size_px: int) -> ByteImage:
    """The square in the middle of an image; smaller where the image is."""
    top, left = (max(0, (length - size_px) // 2) for length in image.shape[:2])
    return image[top : top + size_px, left : left + size_px]


def spread_rows(groups: AnyArray) -> IntArray:
    """Rows of at most 12 patches of each photograph, spread evenly, and 2000 in all."""
    rows: list[int] = []
    for group in dict.fromkeys(groups.tolist()):
        of = np.flatnonzero(groups == group)
        count = min(len(of), PATCHES_PER_PHOTO)
        rows += of[np.linspace(0, len(of) - 1, count).astype(int)].tolist()
    kept = np.linspace(0, len(rows) - 1, min(len(rows), MOST_PATCHES)).astype(int)
    return np.asarray(np.array(rows, dtype=np.intp)[kept])
