"""What `label` prints."""

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from terrain.labelling.given_terrain import GivenTerrain
    from terrain.labelling.label_runs import LabelledTerrain

FEW_PLACES = 5  # as many folds has the cross-validation of `train`


def summary(ground: "LabelledTerrain", told: "Sequence[GivenTerrain]") -> str:
    """Squares of each run, patches of each class, and what is too little for training."""
    return "\n".join([*_runs(ground, told), "", *_classes(ground), *_notes(ground)])


def _runs(ground: "LabelledTerrain", told: "Sequence[GivenTerrain]") -> Iterator[str]:
    for (folder, seen), of in zip(ground.seen.items(), told, strict=True):
        left_out = ground.left_out[folder]
        counts = ", ".join(f"{count} {why}" for why, count in sorted(left_out.items()))
        yield (
            f"{folder}: {seen} squares in images and then driven over, labelled by "
            f"{of.source}; left out: {counts or 'none'}"
        )


def _classes(ground: "LabelledTerrain") -> Iterator[str]:
    scale = ground.scale
    yield (
        f"{len(ground.chosen)} patches of {scale.size_px} px, {scale.metres_per_pixel:g} m per "
        f"pixel, {scale.side_m:.2f} m wide:"
    )
    patches = Counter(each.label for each in ground.chosen)
    places = _places(ground)
    width = max(map(len, patches))
    for label in sorted(patches):
        yield f"  {label:{width}}  {patches[label]:5d} of {places[label]} places"


def _notes(ground: "LabelledTerrain") -> Iterator[str]:
    few = [f"{label} ({count})" for label, count in _places(ground).items() if count < FEW_PLACES]
    if few:
        yield (
            f"Note: patches of few places: {', '.join(few)}; `train` needs 2 a class, and tests "
            f"itself well with {FEW_PLACES} or more"
        )
    if len(_places(ground)) == 1:
        yield "Note: all patches are of one class; `train` needs another one, of another run"


def _places(ground: "LabelledTerrain") -> dict[str, int]:
    pairs = sorted({(each.label, each.photo_id) for each in ground.chosen})
    return dict(Counter(label for label, _ in pairs))
