"""The groups of statistics that stand beside SFTA in the features of a patch, by name."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from odometry.arrays import ByteImage, FloatArray
from terrain.classification.filters import Scales
from terrain.classification.gabor_statistics import gabor_names, gabor_statistics
from terrain.classification.joint_statistics import joint_names, joint_statistics


@dataclass(frozen=True)
class PatchStatistics:
    """One group of features.

    Attributes
    ----------
    of : callable
        The features (n,) of a patch, from its filtered copies by name, what they were made of,
        and the patch in RGB where colour is wanted.
    names : callable
        The names of the n features, from those of the copies and whether colour is wanted.
    """

    of: Callable[[Mapping[str, ByteImage], Scales, ByteImage | None], FloatArray]
    names: Callable[[Sequence[str], bool], list[str]]


STATISTICS = {
    "joint": PatchStatistics(
        joint_statistics, lambda copies, colour: joint_names(copies, colour=colour)
    ),
    "gabor": PatchStatistics(
        lambda _copies, scales, _image: gabor_statistics(scales.grey),
        lambda _copies, _colour: gabor_names(),
    ),
}
