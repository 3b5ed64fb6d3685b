"""What `label` reads of spans and terrains on the command line, and what it prints."""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from terrain.labelling.given_terrain import GivenTerrain, TerrainSpan
    from terrain.labelling.label_runs import LabelledTerrain


FORM = "[RUN:]FROM:TO=TERRAIN, such as 0:20.5=grass, or my_run:0:20.5=grass with several runs"


def spans_by_run(texts: Sequence[str], runs: Sequence[Path]) -> "dict[Path, list[TerrainSpan]]":
    """Spans of each run, from texts such as `0:20=grass` or `my_run:0:20=grass`.

    Raises
    ------
    click.BadParameter
        If a text is not of this form, does not say of which run it is, or a run has no span while
        others have.
    """
    found: dict[Path, list[TerrainSpan]] = {run: [] for run in runs}
    for text in texts:
        run, span = _parsed(text, runs)
        found[run].append(span)
    lacking = [str(run) for run, spans in found.items() if not spans]
    if texts and lacking:
        raise _bad(f"the run {lacking[0]} has no span")
    return found


def _parsed(text: str, runs: Sequence[Path]) -> "tuple[Path, TerrainSpan]":
    from terrain.labelling.given_terrain import TerrainSpan

    times, sign, terrain = text.partition("=")
    *name, begin, end = ["", *times.rsplit(":", 2)][-3:]
    try:
        from_s, to_s = float(begin), float(end)
    except ValueError:
        raise _bad(f"{text!r}, expected {FORM}") from None
    if not sign or not terrain.strip() or terrain.strip() == "unknown":
        raise _bad(f"{text!r}, expected {FORM}")
    if not (math.isfinite(to_s) and 0 <= from_s < to_s):
        raise _bad(f"{text!r}: expected a start of 0 or more, and an end after it")
    return _run_named(name[0], text, runs), TerrainSpan(from_s, to_s, terrain.strip())


def _run_named(name: str, text: str, runs: Sequence[Path]) -> Path:
    if not name and len(runs) == 1:
        return runs[0]
    meant = [run for run in runs if name in (str(run), run.resolve().name)]
    if len(meant) != 1:
        raise _bad(f"{text!r}: there are {len(runs)} runs; begin with the name of one of them")
    return meant[0]


def _bad(message: str) -> click.BadParameter:
    return click.BadParameter(message, param_hint="--span")


FEW_PLACES = 5  # as many folds has the cross-validation of `train`


def summary(labelled: "LabelledTerrain", given: "Sequence[GivenTerrain]") -> str:
    """Squares of each run, patches of each class, and what is too little for training."""
    return "\n".join([*_runs(labelled, given), "", *_classes(labelled), *_notes(labelled, given)])


def _runs(labelled: "LabelledTerrain", given: "Sequence[GivenTerrain]") -> Iterator[str]:
    for (folder, seen), of in zip(labelled.seen.items(), given, strict=True):
        left_out = labelled.left_out[folder]
        counts = ", ".join(f"{count} {why}" for why, count in sorted(left_out.items()))
        yield (
            f"{folder}: {seen} squares in images and then driven over, labelled by "
            f"{of.source}; left out: {counts or 'none'}"
        )


def _classes(labelled: "LabelledTerrain") -> Iterator[str]:
    scale = labelled.scale
    yield (
        f"{len(labelled.chosen)} patches of {scale.size_px} px, {scale.metres_per_pixel:g} m per "
        f"pixel, {scale.side_m:.2f} m wide:"
    )
    patches = Counter(each.label for each in labelled.chosen)
    places = _places(labelled)
    width = max(map(len, patches))
    for label in sorted(patches):
        yield f"  {label:{width}}  {patches[label]:5d} of {places[label]} places"


def _notes(labelled: "LabelledTerrain", given: "Sequence[GivenTerrain]") -> Iterator[str]:
    for folder, of in zip(labelled.seen, given, strict=True):
        yield from (f"Note: {folder}: {note}" for note in of.notes)
    known = {name for each in labelled.chosen for name in (each.label, each.of.label)}
    if lost := sorted({name for of in given for name in of.terrains} - known):
        yield (
            f"Note: no patch shows {', '.join(lost)}: given outside of the recorded time, too "
            "briefly, or where no image shows what was driven over"
        )
    few = [f"{label} ({count})" for label, count in _places(labelled).items() if count < FEW_PLACES]
    if few:
        yield (
            f"Note: patches of few places: {', '.join(few)}; `train` needs 2 of each terrain, "
            f"and {FEW_PLACES} or more for good held-out scores"
        )
    if len(_places(labelled)) == 1:
        yield "Note: all patches are of one terrain; `train` needs a second one, of another run"


def _places(labelled: "LabelledTerrain") -> dict[str, int]:
    pairs = sorted({(each.label, each.photo_id) for each in labelled.chosen})
    return dict(Counter(label for label, _ in pairs))
