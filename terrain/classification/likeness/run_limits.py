"""How far the images of a run may look from the training photographs: learned from these."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np
from scipy.stats import rankdata

from odometry.arrays import AnyArray, FloatArray, IntArray
from terrain.classification.likeness.look import NUMBERS
from terrain.classification.neighbours.rejection import PATCHES, images_of_patches, rejection_limit

FALSE_ALARMS = 0.05  # share of runs over one known terrain beyond a limit
PHOTOS = 3  # of such a run: the least that a run is taken to show
RUNS = 200  # drawn of each terrain
# power of the number of photographs; with 0.5, as if they were independent, runs over all terrains
# of ground/ had false alarms in one of ten
VARIED = 0.25
SHAPES = {"middle": (NUMBERS,), "precision": (NUMBERS, NUMBERS), "variances": (2,), "limits": (3,)}
LEAST_VARIANCE = 1e-3  # of the mean variance, so that a number that never varies decides nothing


@dataclass(frozen=True)
class RunLimits:
    """What runs of three training photographs of one terrain differ from the others.

    The difference of an image is eleven numbers, of which the first and the fourth are not used
    here: the shares of training patches, and of those of the nearest terrain, that are nearer to
    other photographs than it is; its exposure, the share that is darker of the training patches of
    the most similar texture, less one half; the logarithm of its grey over theirs; and its
    displacement, its look in deviations within a terrain less the
    mean of the most similar training looks. The last two vary around zero for images of the
    camera of training; a change of camera, focus or light moves all images in one direction.

    Attributes
    ----------
    middle : FloatArray, shape (7,)
        Mean displacement of the photographs, terrains weighted alike.
    precision : FloatArray, shape (7, 7)
        Inverse of the covariance of their mean displacements.
    variances : FloatArray, shape (2,)
        Of looks within and between photographs, summed over the numbers.
    limits : FloatArray, shape (3,)
        Of the displacement (Mahalanobis distance), and, times the fourth root of the number of
        photographs that a run looks like, of the exposure and of the share within the nearest
        terrain above one half.
    photograph_limits : FloatArray or None, shape (5, 3)
        The same of 1, 2, 4, 8 and 16 patches of one photograph; None of files before version 0.16.
    """

    middle: FloatArray
    precision: FloatArray
    variances: FloatArray
    limits: FloatArray = field(default_factory=lambda: np.ones(3))
    photograph_limits: FloatArray | None = None

    @classmethod
    def of(
        cls, looks: FloatArray, differences: FloatArray, codes: IntArray, groups: AnyArray
    ) -> Self:
        """Of training patches: scaled looks (n, 7), differences (n, 11), terrains, photographs.

        Differences are from the patches of other photographs.
        """
        photos = rows_of_photographs(codes, groups)
        terrains = np.array([codes[rows[0]] for rows in photos])
        weights = 1.0 / np.bincount(terrains)[terrains]
        weights /= weights.sum()
        means = np.array([differences[rows, 4:].mean(axis=0) for rows in photos])
        places = np.array([looks[rows].mean(axis=0) for rows in photos])
        within = weights @ np.array([looks[rows].var(axis=0).sum() for rows in photos])
        between = weights @ ((places - weights @ places) ** 2).sum(axis=1)
        variances = np.array([within, max(float(between), 1e-9)])
        unlimited = cls(*_middle_and_precision(means, weights), variances)
        runs = drawn_runs(photos, terrains)
        apart = [unlimited.apart(looks[rows], differences[rows]) for rows in runs]
        without = [  # its own photograph, by which it would seem nearer
            cls(
                *_middle_and_precision(np.delete(means, i, axis=0), np.delete(weights, i)),
                variances,
            )
            for i in range(len(photos))
        ]
        of_photographs = [_of_parts(without, photos, differences, groups, n) for n in PATCHES]
        return replace(unlimited, limits=_limits(apart), photograph_limits=np.array(of_photographs))

    def apart(self, looks: FloatArray, differences: FloatArray) -> tuple[float, float, float]:
        """How far a run of m images is from training, in the measures of `limits`."""
        varied = self.photographs(looks) ** VARIED
        displacement, exposure, in_terrain = self.of_one(differences)
        return displacement, exposure * varied, in_terrain * varied

    def of_one(self, differences: FloatArray) -> tuple[float, float, float]:
        """The same of patches of one photograph, by their differences (m, 11)."""
        _, in_terrain, exposure, _, *displacement = differences.mean(axis=0)
        mean = np.array(displacement) - self.middle
        away = float(np.sqrt(mean @ self.precision @ mean))
        return away, float(abs(exposure)), float(max(in_terrain - 0.5, 0.0))

    def beyond(self, looks: FloatArray, differences: FloatArray) -> float:
        """The largest of them over its limit: above 1 the images are unlike the photographs."""
        return float(np.max(self.apart(looks, differences) / self.limits))

    def beyond_one(self, differences: FloatArray) -> FloatArray | None:
        """How far patches of one photograph are from training, over each limit (3,).

        Above 1 it is farther than all but one photograph of 20; None without such limits.
        """
        if self.photograph_limits is None:
            return None
        limits = [rejection_limit(len(differences), of.tolist()) for of in self.photograph_limits.T]
        return np.array(self.of_one(differences)) / limits

    def photographs(self, looks: FloatArray) -> float:
        """How many photographs of all terrains vary as much as looks (m, 7): 1 to m.

        With p photographs the images of a run have (1 - 1/p) of the variance between photographs.
        """
        within, between = self.variances
        share = (looks.var(axis=0).sum() - within) / between
        return float(1 / np.clip(1 - share, 1 / len(looks), 1))

    def arrays(self) -> dict[str, AnyArray]:
        """Everything learned, by name."""
        names = [*SHAPES, *([] if self.photograph_limits is None else ["photograph_limits"])]
        return {f"run_{name}": getattr(self, name) for name in names}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, AnyArray]) -> Self | None:
        """Rebuild from what `arrays` gave; None of files before version 0.15, which have none.

        Raises
        ------
        KeyError, ValueError
            If the arrays do not fit.
        """
        if "run_limits" not in arrays:
            return None
        found = {name: arrays[f"run_{name}"] for name in SHAPES}
        of_photographs = arrays.get("run_photograph_limits")
        shapes = {name: array.shape for name, array in found.items()}
        if shapes != SHAPES or (of_photographs is not None and of_photographs.shape != (5, 3)):
            raise ValueError(f"limits of runs of shapes {shapes}")
        return cls(**found, photograph_limits=of_photographs)


def _limits(apart: Sequence[tuple[float, float, float]]) -> FloatArray:
    """What all but one run of 20 keep, (3,): one level for all, so that they do so together."""
    measures = np.array(apart)
    shares = rankdata(measures, axis=0) / len(measures)
    level = np.quantile(shares.max(axis=1), 1 - FALSE_ALARMS)
    return np.asarray(np.maximum(np.quantile(measures, level, axis=0), 1e-9))


def _of_parts(
    without: Sequence[RunLimits],
    photos: Sequence[IntArray],
    differences: FloatArray,
    groups: AnyArray,
    patches: int,
) -> FloatArray:
    """The limits (3,) of so many patches of a photograph; each is judged without itself."""
    apart = [
        of.of_one(differences[rows[part]])
        for of, rows in zip(without, photos, strict=True)
        for part in images_of_patches(groups[rows], patches)
    ]
    return _limits(apart)


def _middle_and_precision(means: FloatArray, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Weighted mean (7,) and inverse covariance (7, 7) of displacements of photographs (n, 7)."""
    shares = weights / weights.sum()
    middle = shares @ means
    spread = (shares[:, None] * (means - middle)).T @ (means - middle)
    spread += max(LEAST_VARIANCE * np.trace(spread) / len(spread), 1e-9) * np.eye(len(spread))
    return middle, np.linalg.inv(spread)


def rows_of_photographs(codes: IntArray, groups: AnyArray) -> list[IntArray]:
    """Rows of each photograph of each terrain."""
    numbers = np.unique(groups, return_inverse=True)[1]
    _, members = np.unique(np.column_stack([codes, numbers]), axis=0, return_inverse=True)
    return [np.flatnonzero(members.ravel() == photo) for photo in range(members.max() + 1)]


def drawn_runs(photos: list[IntArray], terrains: IntArray) -> list[IntArray]:
    """Rows of runs over one terrain each, of photographs drawn at random."""
    rng = np.random.default_rng(0)
    runs = []
    for terrain in np.unique(terrains):
        own = np.flatnonzero(terrains == terrain)
        for _ in range(RUNS):
            drawn = rng.choice(own, min(PHOTOS, len(own)), replace=False)
            runs.append(np.concatenate([photos[i] for i in drawn]))
    return runs
