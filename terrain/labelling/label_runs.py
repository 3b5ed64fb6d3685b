"""From recordings to labelled squares of terrain, chosen place by place."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from odometry.parameters import ParameterSet
from odometry.recording.run import Run
from odometry.replays.terrain_sources import NamedTerrain
from terrain.camera.camera import Camera
from terrain.errors import PatchError
from terrain.labelling.corrections import Corrections
from terrain.labelling.driven_path import DrivenWay
from terrain.labelling.given_terrain import GivenTerrain
from terrain.labelling.scale import LabelConfig, PatchScale, patch_scale
from terrain.labelling.square_labels import LabelledSquare, labelled_squares
from terrain.labelling.squares import SquareFinder, place_centres, places_of
from terrain.main_job import run_odometry
from terrain.spelling import BY_SPELLING, alike_names

ASTRIDE_PLACES, NOT_NEEDED = "across the border of two places", "more than a place needs"
REMOVED = "removed by hand"
SIDES_APART = 5  # of a patch, between places at the least


@dataclass(frozen=True)
class ChosenSquare:
    """A square that becomes a patch.

    Attributes
    ----------
    of : LabelledSquare
    label : str
        The class in which its file lies: `of.label`, or that to which someone moved it.
    photo_id : str
        Of its place, by the coordinates of the centre.
    """

    of: LabelledSquare
    label: str
    photo_id: str


@dataclass(frozen=True)
class LabelledTerrain:
    """What becomes patches, and what does not.

    Attributes
    ----------
    chosen : tuple of ChosenSquare
        By run and image.
    scale : PatchScale
    seen : Mapping of Path to int
        Squares by run that an image shows and the robot drove over.
    left_out : Mapping of Path to (Mapping of str to int)
        How many of them did not become patches, by why.
    """

    chosen: tuple[ChosenSquare, ...]
    scale: PatchScale
    seen: Mapping[Path, int]
    left_out: Mapping[Path, Mapping[str, int]]


def label_runs(
    runs: Sequence[Run],
    given: Sequence[GivenTerrain],
    config: LabelConfig | None = None,
    *,
    parameters: ParameterSet | None = None,
    corrections: Corrections | None = None,
    show_progress: bool = False,
) -> LabelledTerrain:
    """Find squares of terrain that images show and the robot then drove over, and label them.

    Parameters
    ----------
    runs : sequence of Run
        With images and a camera.
    given : sequence of GivenTerrain
        Of each run.
    config : LabelConfig, optional
    parameters : ParameterSet, optional
        ICRs by terrain, for runs without gyroscope and poses.
    corrections : Corrections, optional
    show_progress : bool

    Raises
    ------
    OdometryError
        If a run has no images or camera, two names are spellings of one terrain, nothing can be
        labelled, or a patch that was moved by
        hand is not among the squares any more.

    Examples
    --------
    >>> import odometry
    >>> import terrain
    >>> whole = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> run = odometry.cut_run(whole, odometry.Span(0.0, 6.0))
    >>> labelled = terrain.label_runs([run], [terrain.given_terrain(run)])
    >>> sorted({square.label for square in labelled.chosen})
    ['gravel']
    """
    config, corrections = config or LabelConfig(), corrections or Corrections()
    if alike := alike_names(sorted({name for of in given for name in of.terrains})):
        raise PatchError(
            f"{' and '.join(map(repr, alike))} {BY_SPELLING}; expected one name for each terrain"
        )
    finders = [square_finder(run, of, parameters) for run, of in zip(runs, given, strict=True)]
    scale = patch_scale(finders, config)
    squares: list[LabelledSquare] = []
    seen, left_out = {}, {run.folder: Counter[str]() for run in runs}
    for finder, of, name in zip(finders, given, _names(runs), strict=True):
        rows = finder.image_rows(scale.side_m / 2)
        coarsest_m = scale.coarsest_m
        found = list(finder.squares(scale.side_m, coarsest_m, rows, show_progress=show_progress))
        labelled, counts = labelled_squares(finder, of, found, name)
        seen[finder.run.folder] = len(found)
        left_out[finder.run.folder] += counts
        squares += labelled
    _check_moved(corrections, squares)
    chosen, others = _choose(squares, config, scale, corrections)
    for square, why in others:
        left_out[square.run.folder][why] += 1
    if not chosen:
        whys = sum(left_out.values(), Counter[str]()).most_common()
        said = ", ".join(f"{count} {why}" for why, count in whys)
        raise PatchError(f"no patch is left of {sum(seen.values())} squares of terrain: {said}")
    return LabelledTerrain(tuple(chosen), scale, seen, left_out)


def square_finder(
    run: Run, given: GivenTerrain, parameters: ParameterSet | None = None
) -> SquareFinder:
    """Replay a run without its images, and be ready to find its squares.

    Raises
    ------
    PatchError
        If the run has no images or camera.
    OdometryError
        As `run_odometry`.
    """
    if run.images is None or "camera" not in run.settings:
        lacking = "images.csv" if run.images is None else "[camera] in run.toml"
        raise PatchError(f"{run.folder}: the run has no {lacking}; patches are cut from images")
    camera = Camera.from_table(run.settings["camera"], str(run.folder / "run.toml"))
    named = NamedTerrain.of_answers(given.terrains[0], given.stamps_s, np.array(given.names), ("",))
    source = None if given.of_images else named
    result = run_odometry(run, vision=False, parameters=parameters, source=source)
    odometer, estimate = result.replay.odometer(), result.replay.trajectory()
    way = DrivenWay.of(run, odometer)
    at = odometer if run.pose is None else estimate
    return SquareFinder(run, run.images, camera, way, odometer, at)


def _check_moved(corrections: Corrections, squares: Sequence[LabelledSquare]) -> None:
    """Raise before anyone's corrections are lost."""
    lost = sorted(set(corrections.moved) - {each.name for each in squares})
    if lost:
        raise PatchError(
            f"{len(lost)} patches that were moved by hand, such as {lost[0]}, would not be made "
            "again: other runs, labels or another size; choose another --out, or delete them"
        )


def _choose(
    squares: Sequence[LabelledSquare],
    config: LabelConfig,
    scale: PatchScale,
    corrections: Corrections,
) -> tuple[list[ChosenSquare], list[tuple[LabelledSquare, str]]]:
    """Up to so many squares of each place and label, spread evenly, those moved by hand first."""
    if not squares:
        return [], []
    middles_m = np.array([each.square.place_m for each in squares])
    centres_m = place_centres(middles_m, max(config.place_m, SIDES_APART * scale.side_m))
    places = places_of(middles_m, centres_m, scale.side_m / np.sqrt(2))
    groups: dict[tuple[int, str], list[LabelledSquare]] = {}
    left_out = []
    for each, place in zip(squares, places.tolist(), strict=True):
        if place < 0:
            left_out.append((each, ASTRIDE_PLACES))
        elif each.name in corrections.removed:
            left_out.append((each, REMOVED))
        else:
            groups.setdefault((place, each.label), []).append(each)
    chosen = []
    for (place, _), members in groups.items():
        x, y = centres_m[place].tolist()
        kept = _spread(members, config.per_place, corrections)
        left_out += [(each, NOT_NEEDED) for each in members if each.name not in kept]
        chosen += [
            ChosenSquare(each, corrections.moved.get(each.name, each.label), f"{x:.2f} {y:.2f}")
            for each in members
            if each.name in kept
        ]
    chosen.sort(key=lambda each: each.of.name)
    return chosen, left_out


def _spread(
    members: Sequence[LabelledSquare], most: int, corrections: Corrections
) -> frozenset[str]:
    """Names of at most so many squares; of those that were moved all."""
    moved = {each.name for each in members} & set(corrections.moved)
    others = [each.name for each in members if each.name not in moved]
    count = min(len(others), max(most - len(moved), 0))
    spread = np.linspace(0, len(others) - 1, count).round().astype(int)
    return frozenset(moved | {others[index] for index in spread})


def _names(runs: Sequence[Run]) -> list[str]:
    """Names of runs; with a number where two folders have the same name."""
    names = [run.name for run in runs]
    if len(set(names)) == len(names):
        return names
    return [f"{name}-{number}" for number, name in enumerate(names, 1)]
