"""The groups of statistics that stand beside SFTA in the features of a patch, by name."""

from collections.abc import Callable
from dataclasses import dataclass

from odometry.arrays import FloatArray
from terrain.classification.features.copies import Copies
from terrain.classification.features.gabor_statistics import gabor_names, gabor_statistics
from terrain.classification.features.joint_statistics import joint_names, joint_statistics


@dataclass(frozen=True)
class PatchStatistics:
    """One group of features.

    Attributes
    ----------
    of : callable
        The features (n,) of a patch, from its filtered copies and whether colour is wanted.
    names : callable
        The names of the n features, from whether colour is wanted.
    """

    of: Callable[[Copies, bool], FloatArray]
    names: Callable[[bool], list[str]]


STATISTICS = {
    "joint": PatchStatistics(
        lambda copies, colour: joint_statistics(copies, colour=colour),
        lambda colour: joint_names(colour=colour),
    ),
    "gabor": PatchStatistics(
        lambda copies, _colour: gabor_statistics(copies.scales.grey),
        lambda _colour: gabor_names(),
    ),
}
