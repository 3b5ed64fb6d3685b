"""Window motion of models whose twist is a matrix times the tread speeds, and its derivative.

By each parameter such a twist is a matrix times the same two speeds: sums of ten products along
the samples serve all parameters, and no derivative of a sample is ever built.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.geometry.angles import sine_and_cosine
from odometry.geometry.se2 import NO_ANGLE, SMALL_ANGLE
from odometry.geometry.tilt import Tilt
from odometry.models.base import KinematicModel
from odometry.models.inputs import Inputs
from odometry.windows.travel.windows import Windows

BLOCK = 16384  # samples at a time


@dataclass(frozen=True)
class Block:
    """Some windows, and the samples from the first one's start to the last one's end.

    Attributes
    ----------
    windows, samples : slice
        Which they are.
    ends : (2 K,)
        Where each window starts and ends among these samples, in turn.
    steps_s : (N,)
    tilt : Tilt or None
        Of the samples.
    """

    windows: slice
    samples: slice
    ends: IntArray
    steps_s: FloatArray
    tilt: Tilt | None

    @property
    def first(self) -> IntArray:
        """Samples (K,) at which the windows start."""
        return self.ends[::2]

    @property
    def last(self) -> IntArray:
        """Samples (K,) at which they end."""
        return self.ends[1::2]

    def within(self, steps: FloatArray) -> FloatArray:
        """Sums (..., K) of steps (..., N) from the first to before the last of each window."""
        return np.asarray(np.add.reduceat(steps, self.ends, axis=-1)[..., ::2])


def blocks(windows: Windows) -> Iterator[Block]:
    """The windows in their order."""
    tilt = windows.inputs.tilt
    begins = np.flatnonzero(np.diff(windows.first // BLOCK, prepend=-1))
    for begin, end in pairwise([*begins, len(windows)]):
        chosen = slice(begin, end)
        first, last = windows.first[chosen], windows.last[chosen]
        samples = slice(first.min(), last.max() + 1)
        yield Block(
            chosen,
            samples,
            np.stack([first, last], axis=-1).ravel() - samples.start,
            windows.steps_s[samples],
            None if tilt is None else Tilt(*(part[samples] for part in tilt)),
        )


UNIT_SPEEDS = np.eye(2)


def linear_window_motion(
    model: KinematicModel, values: FloatArray, windows: Windows
) -> tuple[FloatArray, FloatArray]:
    """Motion (K, 3) of each window on level terrain, and its derivative (K, 3, P).

    As `linearised_window_motion`, for a model that `is_linear_in_speeds`: what it does at one tread
    speed of 1 m/s and the other at rest is its matrix (3, 2).
    """
    at_one = model.linearised(values, Inputs(UNIT_SPEEDS))
    matrix, by_parameters = at_one.twist.T, np.moveaxis(at_one.by_parameters, 0, 1)
    motion = np.empty((len(windows), 3))
    derivative = np.empty((len(windows), 3, by_parameters.shape[-1]))
    for block in blocks(windows):
        travel = windows.tread_travel_m[:, block.samples]
        ends, sums = _path(matrix @ travel, travel, block)
        motion[block.windows] = ends
        derivative[block.windows] = _by_parameters(sums, by_parameters)
    return motion, derivative


def _path(
    displacements: FloatArray, travel: FloatArray, block: Block
) -> tuple[FloatArray, FloatArray]:
    """Motion (K, 3) of the windows, and sums (5, 2, K) of what both treads' travel moves there.

    Their rows: x and y by displacements along, x and y by a turn, and the turn. A displacement
    across moves (x, y) as one along moves (y, -x), turned by a quarter.

    Parameters
    ----------
    displacements : (3, N)
        Along, across [m] and turn [rad] of each step.
    travel : (2, N)
        Of the left and the right tread [m].
    block : Block
    """
    along, across, turn = displacements
    half = turn / 2
    yaw = np.cumsum(turn)
    sine, cosine = sine_and_cosine(yaw - half)  # in the middle of each step
    chord, chord_by_turn = _chord(turn, half)
    along_chord, across_chord = chord * cosine, chord * sine
    x_step = along_chord * along - across_chord * across
    y_step = across_chord * along + along_chord * across
    x, y = np.cumsum(x_step), np.cumsum(y_step)
    # a turn bends its own step, and swings what comes after it
    cosine *= chord_by_turn
    sine *= chord_by_turn
    x_by_turn = cosine * along - sine * across
    y_by_turn = sine * along + cosine * across
    x_by_turn += y - y_step / 2
    y_by_turn -= x - x_step / 2
    moved = (along_chord, across_chord, x_by_turn, y_by_turn)
    sums = np.empty((5, 2, len(block.first)))
    for tread, own in enumerate(travel):
        for row, by_step in enumerate(moved):
            sums[row, tread] = block.within(by_step * own)
        sums[4, tread] = block.within(own)

    before = block.last - 1  # no window starts where it ends
    at_start = [np.where(block.first > 0, of[block.first - 1], 0.0) for of in (x, y, yaw)]
    end_x, end_y, end_yaw = (of[before] for of in (x, y, yaw))
    sums[2] -= end_y * sums[4]
    sums[3] += end_x * sums[4]
    sine, cosine = np.sin(at_start[2]), np.cos(at_start[2])
    for i in (0, 2):
        sums[i], sums[i + 1] = (
            cosine * sums[i] + sine * sums[i + 1],
            cosine * sums[i + 1] - sine * sums[i],
        )
    x, y = end_x - at_start[0], end_y - at_start[1]
    motion = np.stack([cosine * x + sine * y, cosine * y - sine * x, end_yaw - at_start[2]], axis=1)
    return motion, sums


def _chord(turn: FloatArray, half: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Chord over arc (N,) of steps that turn, sin(half)/half, and its derivative by the turn."""
    sine, cosine = sine_and_cosine(half)
    straight = np.abs(half) < NO_ANGLE
    chord = (sine + straight) / (half + straight)
    small = np.abs(turn) < SMALL_ANGLE
    return chord, np.where(small, -turn / 12, (cosine - chord) / (turn + small))


def _by_parameters(sums: FloatArray, by_parameters: FloatArray) -> FloatArray:
    """Derivative (K, 3, P) from sums (5, 2, K) and that of the matrix, (3, 2, P)."""
    along, across, turn = by_parameters
    x, y, x_by_turn, y_by_turn, turned = np.moveaxis(sums, 2, 1)  # (K, 2) each
    return np.stack(
        [
            x @ along - y @ across + x_by_turn @ turn,
            y @ along + x @ across + y_by_turn @ turn,
            turned @ turn,
        ],
        axis=1,
    )
