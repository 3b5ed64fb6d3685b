"""How the motion in images goes with that of the robot: when, in which size and direction."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from odometry.arrays import FloatArray
from odometry.checks.evidence.cleaned_recording import CleanedRecording
from odometry.recording.run import Run
from terrain.checks.ground_steps import GroundSteps

Complex = NDArray[np.complex128]

LARGEST_LAG_S, LAG_STEP_S = 10.0, 0.05
ORDINARY_WIDTH = 1.8  # effective width in track widths, where no gyroscope measures the turn
# Standard deviations of a step at the least: on level terrain, by a camera that does not rock
PLACE_M, PLACE, TURN_RAD, TURN = 0.01, 0.05, 0.02, 0.1
MEDIAN = 1.2  # of the larger of two such deviations, by chance
ROUNDS = 5  # of reweighting
BLOCKS = 8  # of the run, each left out once (jackknife)
TINY = 1e-12


@dataclass(frozen=True, eq=False)
class Agreement:
    """How steps by P pairs of images go with those of the robot, at G lags of the images.

    Attributes
    ----------
    gains : (G,) of complex
        Steps by images over those of the treads, their size and direction.
    gain_sds : (G,)
        Standard deviations of their real and imaginary parts.
    turns, turn_sds : (G,)
        Turns by images over those of the robot, and their standard deviations.
    off : (G, P)
        What is left of a step and a turn, the larger of both in standard deviations.
    losses : (G, P)
        Cauchy's loss of both [nats].
    """

    gains: Complex
    gain_sds: FloatArray
    turns: FloatArray
    turn_sds: FloatArray
    off: FloatArray
    losses: FloatArray


def agreement(
    steps: FloatArray, travel_m: FloatArray, turn_rad: FloatArray, noise: float
) -> Agreement:
    """Compare steps (P, 3) by images with travel (G, P) and turn (G, P) of the robot.

    A robot turns about its ICR and not about its origin, and a camera may stand elsewhere than it
    is said to: both swing the step by the turn, about a place that is fitted beside the gain.
    """
    place, yaw = steps[:, 0] + 1j * steps[:, 1], steps[:, 2].astype(np.complex128)
    half: Complex = np.exp(0.5j * turn_rad)
    whole: Complex = np.exp(1j * turn_rad)
    moved = travel_m * np.sinc(turn_rad / (2 * np.pi)) * half
    swung: Complex = whole - 1.0
    place_sd = noise * (PLACE_M + PLACE * np.abs(place))
    turn_sd = noise * (TURN_RAD + TURN * np.abs(yaw))
    off, aside = np.zeros(moved.shape), np.zeros(moved.shape)
    for _ in range(ROUNDS):
        of_place, of_turn = 1 / ((1 + off**2) * place_sd**2), 1 / ((1 + aside**2) * turn_sd**2)
        gains, swings, gain_sds = _slopes(place, moved, swung, of_place)
        squares = (of_turn * turn_rad**2).sum(axis=1) + TINY
        turns = (of_turn * turn_rad * yaw.real).sum(axis=1) / squares
        left = place - gains[:, None] * moved - swings[:, None] * swung
        off, aside = np.abs(left) / place_sd, np.abs(yaw - turns[:, None] * turn_rad) / turn_sd
    losses = np.log1p(off**2) + np.log1p(aside**2)
    return Agreement(gains, gain_sds, turns, 1 / np.sqrt(squares), np.maximum(off, aside), losses)


def _slopes(
    values: Complex, one: Complex, other: Complex, weights: FloatArray
) -> tuple[Complex, Complex, FloatArray]:
    """Weighted slopes (G,) of values (P,) over two others (G, P), and the first's deviation."""
    a, b = (weights * np.abs(one) ** 2).sum(axis=1), (weights * np.abs(other) ** 2).sum(axis=1)
    both = (weights * one.conj() * other).sum(axis=1)
    of_one, of_other = ((weights * by.conj() * values).sum(axis=1) for by in (one, other))
    known = a - np.abs(both) ** 2 / (b + TINY) + TINY
    slope = (of_one - both * of_other / (b + TINY)) / known
    return slope, (of_other - both.conj() * slope) / (b + TINY), np.asarray(1 / np.sqrt(known))


@dataclass(frozen=True, eq=False)
class ImageMotion:
    """The motion in the images of a run beside that of its treads.

    Attributes
    ----------
    run : Run
    steps : GroundSteps
    """

    run: Run
    steps: GroundSteps

    @cached_property
    def lags_s(self) -> FloatArray:
        """Lags (G,) that are tried: 0 in the middle, above 0 where images are late."""
        count = round(LARGEST_LAG_S / LAG_STEP_S)
        return np.asarray(LAG_STEP_S * np.arange(-count, count + 1), dtype=np.float64)

    @cached_property
    def noise(self) -> float:
        """Factor of the standard deviations: at the best lag half of the pairs are within."""
        off = self._steady.off[int(self.plain_losses.argmin())]
        return max(1.0, float(np.median(off)) / MEDIAN)

    @cached_property
    def robot_at_lags(self) -> tuple[FloatArray, FloatArray]:
        """Travel [m] and turn [rad] (G, P) of the robot at every lag."""
        return self._robot(np.asarray(self.steps.stamps_s - self.lags_s[:, None, None]))

    @cached_property
    def _steady(self) -> Agreement:
        return agreement(self.steps.steps, *self.robot_at_lags, 1.0)

    @property
    def plain_losses(self) -> FloatArray:
        """Loss (G,) at every lag, by a camera that does not rock."""
        return np.asarray(self._steady.losses.sum(axis=1))

    @property
    def plain_gains(self) -> tuple[complex, float, float, float]:
        """Gain and its deviation, turn and its deviation, at the lag of the least of these."""
        found, best = self._steady, int(self.plain_losses.argmin())
        return (
            complex(found.gains[best]),
            float(found.gain_sds[best]),
            float(found.turns[best]),
            float(found.turn_sds[best]),
        )

    @cached_property
    def plain_reversed_loss(self) -> float:
        """The same where the last image was taken first."""
        return self._loss_of(*self._robot_reversed, 1.0)

    @cached_property
    def plain_even_loss(self) -> float:
        """Loss of the steps of the treads against even motion: how much there is to agree with."""
        travel_m, turn_rad = (of[0] for of in self._robot(self.steps.stamps_s[None]))
        moved = travel_m * np.sinc(turn_rad / (2 * np.pi)) * np.exp(0.5j * turn_rad)
        steps = np.column_stack([moved.real, moved.imag, turn_rad])
        found = agreement(steps, *self._even(steps), 1.0)
        return float(found.losses.sum())

    @cached_property
    def by_lag(self) -> Agreement:
        """At every lag."""
        return agreement(self.steps.steps, *self.robot_at_lags, self.noise)

    @cached_property
    def losses(self) -> FloatArray:
        """Loss (G,) of all pairs at every lag [nats]."""
        return np.asarray(self.by_lag.losses.sum(axis=1))

    @cached_property
    def best(self) -> int:
        """Place of the lag that fits best."""
        return int(self.losses.argmin())

    @property
    def is_within(self) -> bool:
        """Whether the best lag is none of the ends of the search."""
        return 0 < self.best < len(self.lags_s) - 1

    @cached_property
    def lag_sd_s(self) -> float:
        """Standard deviation of that lag, by leaving out one stretch of the run after the other."""
        blocks = np.array_split(np.arange(len(self.steps)), BLOCKS)
        left = [self.losses - self.by_lag.losses[:, block].sum(axis=1) for block in blocks]
        found = self.lags_s[np.argmin(left, axis=1)]
        spread = np.sqrt((BLOCKS - 1) / BLOCKS * np.sum((found - found.mean()) ** 2))
        return max(float(spread), LAG_STEP_S / 2)

    @cached_property
    def reversed_loss(self) -> float:
        """Loss where the last image was taken first."""
        return self._loss_of(*self._robot_reversed, self.noise)

    @cached_property
    def _robot_reversed(self) -> tuple[FloatArray, FloatArray]:
        stamps_s = self.run.images.stamps_s if self.run.images is not None else np.zeros(1)
        back_s = stamps_s[::-1][self.steps.rows]
        return self._robot(back_s[None])

    @cached_property
    def even_loss(self) -> float:
        """Loss of a robot that moves in the same way all the time."""
        return self._loss_of(*self._even(self.steps.steps), self.noise)

    def _even(self, steps: FloatArray) -> tuple[FloatArray, FloatArray]:
        lasts_s = np.diff(self.steps.stamps_s, axis=1)[:, 0]
        x, y, yaw = np.median(steps / lasts_s[:, None], axis=0)
        return np.hypot(x, y) * lasts_s[None], yaw * lasts_s[None]

    def _loss_of(self, travel_m: FloatArray, turn_rad: FloatArray, noise: float) -> float:
        return float(agreement(self.steps.steps, travel_m, turn_rad, noise).losses.sum())

    def _robot(self, stamps_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        return robot_motion(self.run, stamps_s)


def robot_motion(run: Run, stamps_s: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Travel [m] and turn [rad] (G, P) of the robot between stamps (G, P, 2)."""
    odometry_s = run.odometry.stamps_s
    at_s = stamps_s.clip(odometry_s[0], odometry_s[-1]).ravel()
    of = CleanedRecording(run).integrals
    left, right, turn = (
        np.diff(integral(at_s).reshape(stamps_s.shape), axis=2)[..., 0]
        for integral in (of.left_m, of.right_m, of.gyroscope_rad)
    )
    by_treads = (right - left) / (ORDINARY_WIDTH * run.robot.track_width)
    return (left + right) / 2, np.where(np.isfinite(turn), turn, by_treads)
