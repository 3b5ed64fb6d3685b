"""The label of each square: the terrain that was given while the footprint was over it."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.geometry import se2
from odometry.recording.run import Run
from terrain.labelling.given_terrain import GivenTerrain
from terrain.labelling.squares import DrivenSquare, SquareFinder

STRADDLES, UNNAMED = "astride two terrains", "of no given terrain"


@dataclass(frozen=True)
class LabelledSquare:
    """A square and its terrain.

    Attributes
    ----------
    run : Run
    square : DrivenSquare
    label : str
    name : str
        Of the patch, and of its file; no other square has it.
    confidence : float
        The least probability of the label while the footprint was over it; NaN where what gave it
        has none.
    """

    run: Run
    square: DrivenSquare
    label: str
    name: str
    confidence: float = float("nan")


def labelled_squares(
    finder: SquareFinder, given: GivenTerrain, squares: Sequence[DrivenSquare], run_name: str
) -> tuple[list[LabelledSquare], Counter[str]]:
    """Squares of one terrain, and how many others there are, by why they are left out.

    The label is the terrain of all the time during which the footprint was over any part of the
    square. Where images are labelled, it is what all images say that show the middle of the
    square before the robot gets there.

    Parameters
    ----------
    finder : SquareFinder
    given : GivenTerrain
    squares : sequence of DrivenSquare
        Of the finder.
    run_name : str
        A name that no other run has.
    """
    found, left_out = [], Counter[str]()
    for square in squares:
        names = _names(finder, given, square)
        if len(names - {""}) > 1:
            left_out[STRADDLES] += 1
        elif "" in names:
            left_out[UNNAMED] += 1
        else:
            (label,) = names
            name = f"{run_name}_{_place(square)}.png"
            over = square.passing
            confidence = given.least_probability(over.begin_s, over.end_s)
            found.append(LabelledSquare(finder.run, square, label, name, confidence))
    return found, left_out


def _names(finder: SquareFinder, given: GivenTerrain, square: DrivenSquare) -> frozenset[str]:
    if not given.of_images:
        return given.between(square.passing.begin_s, square.passing.end_s)
    first, end = finder.rows_before(square)
    robot = se2.inverse(finder.poses[first:end])
    from_robot = se2.transform(robot, np.array(square.middle_m))
    shows = finder.camera.shows_terrain(finder.camera.ground_to_pixels(from_robot))
    names = {given.names[first + int(image)] for image in np.flatnonzero(shows)}
    return frozenset(names - {""} or {""})


def _place(square: DrivenSquare) -> str:
    """Image and place in it: so many centimetres ahead and to the left of the robot."""
    image = square.image.rsplit(".", 1)[0].removeprefix("images/").replace("/", "-")
    ahead, left = np.rint(100 * square.rectangle.middle).astype(int).tolist()
    return f"{image}_{ahead:+04d}_{left:+04d}"
