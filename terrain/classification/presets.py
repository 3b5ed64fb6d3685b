"""The two ways to classify terrain, as a table."""

from collections.abc import Callable
from dataclasses import dataclass

from terrain.classification.features import (
    COLOUR_COPIES,
    FEWER_GREYS,
    GREY_COPIES,
    FeatureSettings,
)
from terrain.classification.neighbours import (
    DiscriminantNeighbours,
    Neighbours,
    linear_neighbours,
)
from terrain.classification.plain_neighbours import PlainNeighbours


@dataclass(frozen=True)
class Preset:
    """What a preset computes of a patch, and how it looks for neighbours.

    Attributes
    ----------
    features, colour_features : FeatureSettings
        Without and with colour.
    neighbours : type
        One of the classes of `terrain.classification.neighbours`.
    ways : tuple of callable
        What makes them: cross-validation chooses one.
    neighbour_counts : tuple of int
        The numbers k of neighbours among which cross-validation chooses.
    as_published : bool
        Votes are the probabilities, nothing but the photographs is learned from, and one distance
        rejects whatever the number of patches.
    one_patch : bool
        Of the region in an image of a run the patch in its middle alone is looked at.
    """

    features: FeatureSettings
    colour_features: FeatureSettings
    neighbours: type[Neighbours]
    ways: tuple[Callable[[], Neighbours], ...]
    neighbour_counts: tuple[int, ...]
    as_published: bool = False
    one_patch: bool = False


_CHEN2023 = FeatureSettings(("grey",), (), n_thresholds=4, counts_per_area=False)
_ALL_GREY = tuple(GREY_COPIES)
_ALL_COLOUR = tuple(COLOUR_COPIES)
_FEW_GREY = ("grey", "magnitude_0.7", "coherence_0.7", "band_2")  # chosen one after another
_DISCRIMINANT = (
    DiscriminantNeighbours,
    (linear_neighbours, DiscriminantNeighbours),
    (5, 9, 15, 25, 45),
)


def _of(grey_copies: tuple[str, ...], colour_copies: tuple[str, ...] = ()) -> FeatureSettings:
    return FeatureSettings(grey_copies, colour_copies, 4, True, filtered_greys=FEWER_GREYS)


PRESETS = {
    "default": Preset(_of(_ALL_GREY), _of(_ALL_GREY, _ALL_COLOUR), *_DISCRIMINANT),
    "fast": Preset(_of(_FEW_GREY), _of(_FEW_GREY, _ALL_COLOUR), *_DISCRIMINANT, one_patch=True),
    "chen2023": Preset(
        _CHEN2023,
        _CHEN2023,
        PlainNeighbours,
        (PlainNeighbours,),
        (1, 3, 5, 9, 15),
        as_published=True,
    ),
}
