"""What to drive next: the drive on which rivals differ most, and the odds that it decides.

Each rival is simulated on a handful of drives, and the other one is fitted to it again within what
the recordings leave open of both. With D^2 the chi-squared that is left, the gain of
log-likelihood of the right one over the wrong one, twice, is normal with mean D^2 and standard
deviation 2 D (two simple hypotheses under white noise): the odds that it exceeds the margin which
a name needs follow in closed form.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import norm

from odometry.arrays import FloatArray
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added, corrected_twist, reported_yaw_rate
from odometry.effects.interface.in_course import lasting
from odometry.effects.measurement.reference_fault import FEW_HEADINGS
from odometry.gap.answer.drives import Drive, drives_of, scene_of
from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitted
from odometry.gap.fit.hypothesis import RIDGE, Hypothesis
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.measured import measured_of
from odometry.gap.prepare.simulate import simulated_poses
from odometry.gap.solve import differences
from odometry.windows.dense.dense import DenseWindows


@dataclass(frozen=True)
class NextDrive:
    """A drive that would distinguish two effects.

    Attributes
    ----------
    words : str
        What to drive for a minute, with its numbers.
    between : (str, str)
        Names of the effects.
    odds : float
        Probability that the right one of them then leads by the margin of a name, whichever it
        is.
    """

    words: str
    between: tuple[str, str]
    odds: float


@dataclass(frozen=True)
class Rivalling:
    """Effects that are there at any time, with the base, and how well both are known."""

    base: Base
    effects: tuple[Added, ...]
    covariance: FloatArray


def next_drives(
    rivals: Mapping[str, Fitted],
    scenes: Sequence[DenseWindows],
    calibration: Calibration,
    config: GapConfig,
) -> tuple[NextDrive, ...]:
    """A drive for each rival of a named effect, one for all where there is such; none, if in vain.

    Of drives that decide as well, it is the one of more different motions: what is true may be
    none of these effects. Effects that follow the heading need a drive that looks all round.

    Parameters
    ----------
    rivals : Mapping of name to Fitted
        The named effect first, then those that the recordings do not distinguish from it.
    scenes : sequence of DenseWindows
        Measured: speeds, slopes and pose rate are theirs.
    """
    (name, named), *others = ((key, rivalling(fit)) for key, fit in rivals.items())
    drives, odds = drives_of(scenes, calibration.base, config), []
    pairs = [(named, rival) for _, rival in others]
    of_headings = [any(_lacks_headings(one, scenes) for one in pair) for pair in pairs]
    for drive in drives:
        odds.append(
            [
                _odds(drive, pair, scenes[0], calibration, config)
                if drive.all_round or not all_round
                else 0.0
                for pair, all_round in zip(pairs, of_headings, strict=True)
            ]
        )
        if min(odds[-1]) >= config.sure_odds:
            break
    table = np.array(odds)
    for_all = int(np.argmax(table.mean(axis=1).round(1)))
    found = []
    for column, (other, _) in enumerate(others):
        its_best = int(np.argmax(table[:, column]))
        best = for_all if table[for_all, column] >= config.least_odds else its_best
        if table[best, column] >= config.least_odds:
            found.append(NextDrive(drives[best].words, (name, other), float(table[best, column])))
    return tuple(found)


def _lacks_headings(one: Rivalling, scenes: Sequence[DenseWindows]) -> bool:
    """Whether its effects follow the heading, and no run looks all round."""
    return any(
        all(added.effect.lacks(scene.inputs, one.base) == FEW_HEADINGS for scene in scenes)
        for added in one.effects
    )


def odds_of(chi_squared: float, margin: float) -> float:
    """Probability that twice the gain of log-likelihood exceeds a margin."""
    if chi_squared <= 0:
        return 0.0
    return float(norm.cdf((chi_squared - margin) / (2 * np.sqrt(chi_squared))))


def _odds(
    drive: Drive,
    pair: tuple[Rivalling, Rivalling],
    like: DenseWindows,
    calibration: Calibration,
    config: GapConfig,
) -> float:
    """The odds on one drive, where the less favourable one is true."""
    scene = scene_of(drive, calibration.base, like)
    left = [
        chi_squared_left(true, other, scene, calibration, config)
        for true, other in (pair, pair[::-1])
    ]
    return min(odds_of(value, config.least_evidence) for value in left)


def chi_squared_left(
    true: Rivalling,
    other: Rivalling,
    scene: DenseWindows,
    calibration: Calibration,
    config: GapConfig,
) -> float:
    """Chi-squared of a drive of the one rival that is left when the other is fitted to it.

    Linearised about the values of the other, which may move as far as the recordings leave open.
    """
    measured = measured_of([as_driven(true, scene)], calibration, config)
    hypothesis = Hypothesis(calibration, measured, tuple(one.effect for one in other.effects))
    of_base = replace(calibration.uncertain, base=other.base).values
    values = np.concatenate([of_base, *(one.values for one in other.effects)])

    def rows_at(at: FloatArray) -> FloatArray:
        return measured.rows(*hypothesis.split(at))

    rows = rows_at(values)
    own = np.unique(hypothesis.places)
    jacobian = differences(rows_at, values, rows, hypothesis.scales, hypothesis.bounds)[:, own]
    of_effects = own[len(of_base) :] - len(of_base)
    covariance = other.covariance[np.ix_(of_effects, of_effects)]
    known = np.zeros((len(own), len(own)))
    known[: len(of_base), : len(of_base)] = calibration.information
    known[len(of_base) :, len(of_base) :] = np.linalg.pinv(covariance, hermitian=True)
    normal = jacobian.T @ jacobian + known
    gradient = jacobian.T @ rows
    step = np.linalg.solve(normal + RIDGE * np.eye(len(own)), gradient)
    return max(0.0, float(rows @ rows - gradient @ step))


def as_driven(true: Rivalling, scene: DenseWindows) -> DenseWindows:
    """The drive as poses and gyroscope would report it, without noise."""
    poses = simulated_poses(true.base, true.effects, scene)
    inputs = scene.inputs
    if inputs.yaw_rate_rad_s is not None:
        omega = corrected_twist(true.base, true.effects, inputs)[:, 2]
        rates = reported_yaw_rate(true.effects, omega, inputs)
        inputs = replace(inputs, yaw_rate_rad_s=rates)
    return replace(scene, poses=poses, inputs=inputs)


def rivalling(fitted: Fitted) -> Rivalling:
    """The effects as they are at the end of their course."""
    kept, place = [], 0
    effects = tuple(map(lasting, fitted.effects))
    for whole, end in zip(fitted.effects, effects, strict=True):
        kept += list(range(place, place + len(end.values)))
        place += len(whole.values)
    return Rivalling(fitted.base, effects, fitted.covariance[np.ix_(kept, kept)])
