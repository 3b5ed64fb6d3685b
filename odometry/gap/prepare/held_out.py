"""Which stretches of the measured runs are held out, where no whole runs are."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import IntArray
from odometry.errors import GapError
from odometry.gap.config import GapConfig
from odometry.gap.prepare.pieces import pieces
from odometry.windows.dense.dense import DenseWindows, thinned

Apart = tuple[list[DenseWindows], list[DenseWindows]]  # to fit to, and to evaluate on
STANDING_M_S = 0.05  # mean tread speed of a piece below which it shows no effect
STANDING = 0.25  # the same as a share of that of the run, of slow robots


def held_out_pieces(scenes: Sequence[DenseWindows], config: GapConfig) -> list[IntArray]:
    """Numbers of the pieces of each run that are held out: every so many of those that move.

    By their order in time, not by their error: of a short recording, the worst piece would then
    always be one that is fitted to. Stationary pieces agree with any model: an evaluation on them
    means nothing.

    Raises
    ------
    GapError
        If no piece is left to hold out.
    """
    every = config.held_back
    numbers = [moving_pieces(scene, config.part_s)[every - 1 :: every] for scene in scenes]
    if not any(map(len, numbers)):
        raise GapError(
            "the measured runs are too short to hold stretches of them back: expected "
            f"{every * config.part_s:g} s or more with moving treads, or --holdout"
        )
    return numbers


def apart(
    groups: tuple[Sequence[DenseWindows], Sequence[DenseWindows]],
    numbers: Sequence[IntArray] | None,
    config: GapConfig,
) -> Apart:
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
    """Numbers of the pieces of a run in which its treads move, as fast as this robot does."""
    number = pieces(scene, part_s)
    ends_s = scene.pose_s[scene.windows[:, [0, -1]]]
    travel_m = np.diff(np.interp(ends_s, scene.time_s, scene.travel_m), axis=1)[:, 0]
    lasting_s = ends_s[:, 1] - ends_s[:, 0]
    mean_m_s = float(travel_m.sum() / lasting_s.sum())
    moving_m = min(STANDING_M_S, STANDING * mean_m_s) * lasting_s
    surplus_m = np.bincount(number, weights=travel_m - moving_m)
    return np.flatnonzero(surplus_m > 0)
