"""How the training photographs look: sharpness, scale, exposure and compression."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np
from scipy.spatial.distance import cdist

from odometry.arrays import AnyArray, ByteImage, FloatArray, IntArray
from terrain.classification.likeness.likeness import FEWEST_IMAGES, Likeness
from terrain.classification.likeness.look import NUMBERS, look_of, spread_patches
from terrain.classification.likeness.run_limits import RunLimits

TEXTURE = slice(2, 6)
# what it is to be low or high in them
WORDS = (
    ("darker", "brighter"),
    ("of less contrast", "of more contrast"),
    ("more blurred", "sharper or noisier"),
    *[("coarser", "finer")] * 3,  # of all octaves
    ("more compressed", "less compressed"),
)
NEAREST = 3
SIMILAR = 30  # patches of the most similar texture
GREY = 0.01  # of white, beside a mean of grey: black has no logarithm
MOST_WORDS = 3
WORTH_NAMING = 0.5  # deviations within a terrain


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
    limits : RunLimits or None
        None of files before version 0.15.
    """

    looks: FloatArray
    codes: IntArray
    distances: FloatArray
    limits: RunLimits | None = None

    @classmethod
    def of(cls, patches: Sequence[ByteImage], codes: IntArray, groups: AnyArray) -> Self:
        """Of square patches with terrains (n,) and photographs (n,), at least two of each."""
        patches, codes, groups = spread_patches(patches, codes, groups)
        looks = np.array([look_of(patch) for patch in patches])
        unknown = cls(looks, codes, np.zeros(len(looks)))
        own = groups[:, None] == groups
        first = replace(unknown, distances=unknown._nearest(looks, own)[0])
        differences = first.differences(looks, own)
        return replace(first, limits=RunLimits.of(first._scaled, differences, codes, groups))

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

    def compared(self, looks: FloatArray, images: int | None = None) -> Likeness:
        """Compare the looks (m, 7) of images, or of the patches of few images."""
        return self.summary(looks, self.differences(looks) if len(looks) else looks, images)

    def displacement(self, differences: FloatArray) -> float:
        """How far an image lies from the most similar training looks, by its differences (m, 11).

        Above 1 it is farther than most photographs held out.

        Raises
        ------
        ValueError
            If the model is of a file before version 0.16, without limits for one photograph.
        """
        beyond = None if self.limits is None else self.limits.beyond_one(differences)
        if beyond is None:
            raise ValueError("no limits of the looks of one photograph")
        return float(beyond[0])

    def differences(self, looks: FloatArray, left_out: AnyArray | None = None) -> FloatArray:
        """How each of looks (m, 7) differs from the training patches, (m, 11): see `RunLimits`."""
        distances, nearest = self._nearest(looks, left_out)
        nearer = self.distances < distances[:, None]
        own = self.codes == self.codes[nearest][:, None]
        in_terrain = (nearer & own).sum(axis=1) / own.sum(axis=1)
        scaled = looks[:, : len(self.spread)] / self.spread
        similar = self._scaled[self._similar(scaled, slice(None), left_out)].mean(axis=1)
        of_texture = self.looks[self._similar(scaled, TEXTURE, left_out), 0]
        exposures = (of_texture < looks[:, :1]).mean(axis=1) - 0.5
        light = np.log(looks[:, 0] + GREY) - np.log(of_texture + GREY).mean(axis=1)
        return np.column_stack(
            [nearer.mean(axis=1), in_terrain, exposures, light, scaled - similar]
        )

    def summary(
        self, looks: FloatArray, differences: FloatArray, images: int | None = None
    ) -> Likeness:
        """Of the looks (m, 7) of a run, or of patches of few images, and their differences."""
        images = len(looks) if images is None else images
        if not images:
            return Likeness(0, float("nan"), float("nan"), ())
        rank, in_class, exposure, light = differences.mean(axis=0)[:4].tolist()
        beyond = None
        if self.limits is not None and images < FEWEST_IMAGES:
            of_one = self.limits.beyond_one(differences)
            beyond = None if of_one is None else float(of_one.max())
        elif self.limits is not None:
            beyond = self.limits.beyond(looks / self.spread, differences)
        how = self.how(looks)
        return Likeness(images, rank, in_class, how, exposure + 0.5, beyond, float(np.exp(light)))

    def _similar(self, scaled: FloatArray, numbers: slice, left_out: AnyArray | None) -> IntArray:
        """Rows (m, 30) of the most similar patches by some numbers of scaled looks (m, 7)."""
        apart = cdist(scaled[:, numbers], self._scaled[:, numbers])
        few = min(SIMILAR, apart.shape[1])
        if left_out is not None:
            apart[left_out] = np.inf
            few = min(few, int((~left_out).sum(axis=1).min()))
        return np.argpartition(apart, few - 1, axis=1)[:, :few]

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
        } | ({} if self.limits is None else self.limits.arrays())

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
        limits = RunLimits.from_arrays(arrays) if looks.shape[1] == NUMBERS else None
        return cls(looks, codes, own, limits)
