"""Which stretches of the measured runs are held out, where no whole runs are."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.errors import GapError
from odometry.gap.config import GapConfig
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.pieces import pieces
from odometry.gap.prepare.statistic import Measure, floor_of, squared_errors
from odometry.windows.dense import DenseWindows, thinned

STANDING_M_S = 0.05  # mean tread speed of a piece below which it shows no effect
FIRST = 1  # of the pieces, those of the largest error first: to fit to, and this one to hold out


def held_out_pieces(
    scenes: Sequence[DenseWindows], known: Calibration, config: GapConfig, *, has_yaw: bool
) -> list[IntArray]:
    """Numbers of the pieces of each run that are held out: one in so many of those that move.

    Dealt out by their error as the base was calibrated, so that what acts in few pieces is in some
    to fit to and in some held out. Stationary pieces agree with any model: an evaluation on them
    means nothing.

    Raises
    ------
    GapError
        If no piece is left to hold out, or none to fit to.
    """
    numbers = []
    for scene in scenes:
        moving = moving_pieces(scene, config.part_s)
        errors = _errors(scene, known, config, has_yaw=has_yaw)
        of_piece = pieces(scene, config.part_s)
        means = [float(errors[of_piece == number].mean()) for number in moving]
        order = moving[np.argsort(means, kind="stable")[::-1]]
        numbers.append(np.sort(order[FIRST :: config.held_back]))
    if not any(map(len, numbers)):
        raise GapError(
            "the measured runs are too short to hold stretches of them back: expected "
            f"{config.held_back * config.part_s:g} s or more with moving treads, or --holdout"
        )
    return numbers


def apart(
    groups: tuple[Sequence[DenseWindows], Sequence[DenseWindows]],
    numbers: Sequence[IntArray] | None,
    config: GapConfig,
) -> tuple[list[DenseWindows], list[DenseWindows]]:
    """Scenes to fit and scenes to evaluate.

    Of those measured, pieces of these numbers are held out; None where whole runs are.
    """
    measured, held = groups
    if numbers is not None:
        outs = [
            np.isin(pieces(scene, config.part_s), own)
            for scene, own in zip(measured, numbers, strict=True)
        ]
        held = [scene.where(out) for scene, out in zip(measured, outs, strict=True) if out.any()]
        measured = [s.where(~out) for s, out in zip(measured, outs, strict=True) if not out.all()]
    return [thinned(scene, config.most_windows) for scene in measured], list(held)


def moving_pieces(scene: DenseWindows, part_s: float) -> IntArray:
    """Numbers of the pieces of a run in which its treads move."""
    number = pieces(scene, part_s)
    ends_s = scene.pose_s[scene.windows[:, [0, -1]]]
    travel_m = np.diff(np.interp(ends_s, scene.time_s, scene.travel_m), axis=1)[:, 0]
    moving_m = STANDING_M_S * (ends_s[:, 1] - ends_s[:, 0])
    surplus_m = np.bincount(number, weights=travel_m - moving_m)
    return np.flatnonzero(surplus_m > 0)


def _errors(
    scene: DenseWindows, known: Calibration, config: GapConfig, *, has_yaw: bool
) -> FloatArray:
    """Squared errors (K,) of all that is measured, each in its noise floor."""
    measures = [Measure.POSITION, *([Measure.HEADING] if has_yaw else [])]
    if scene.reported_turns is not None:
        measures.append(Measure.GYROSCOPE)
    errors = np.zeros(len(scene))
    for measure in measures:
        floor = floor_of(known.held_back, config.part_s, measure)
        errors += squared_errors(known.base, (), scene, measure) / floor.value**2
    return errors
