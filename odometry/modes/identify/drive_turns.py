"""How each drive turns the robot: whether it turns at all, and as the others of its terrain do."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import RunFolderError
from odometry.modes.identify.mode_windows import stretches_by_label
from odometry.modes.recorded.bank_inputs import velocity_signals
from odometry.recording.run import UNKNOWN, Run

BLOCK_S = 1.0  # of means: a lag of the yaw rate matters little
LEAST_SIGMAS = 5.0  # by which a gain differs from 0: terrains differ by less than its error else
LEAST_APART = 0.03  # of gains; those of one terrain differ by 1 to 2 % from drive to drive
SIGMAS = 3.0  # by which gains of two drives differ
NEARER = 0.5  # times as far as the nearest drive of its own name
MOST_NOTES = 3


@dataclass(frozen=True)
class DriveTurns:
    """Of a run on one terrain.

    Attributes
    ----------
    run : str
    gain_rad_m : float
        Yaw rate by the difference of the tread speeds; NaN where these do not differ.
    information, left : float
        Sum of squares of the difference, and of what the gain leaves of the yaw rates.
    blocks : int
    """

    run: str
    gain_rad_m: float
    information: float
    left: float
    blocks: int

    @property
    def sigma_rad_m(self) -> float:
        """Standard deviation of the gain."""
        freedom = max(self.blocks - 3, 1)
        return float(np.sqrt(self.left / freedom / max(self.information, 1e-18)))


def drive_turns(runs: Sequence[Run]) -> dict[str, list[DriveTurns]]:
    """Turns of every run by terrain; none of runs without a yaw rate."""
    found: dict[str, list[DriveTurns]] = {}
    for run in runs:
        try:
            signals = velocity_signals(run)
        except RunFolderError:
            continue
        columns = np.column_stack([signals.tread_speeds_m_s, signals.measured[:, 1]])
        parts: dict[str, list[FloatArray]] = {}
        for name, rows in stretches_by_label(run, signals.labels):
            means = _block_means(signals.stamps_s[rows], columns[rows])
            parts.setdefault(name, []).append(_without_speed(means))
        for name, of in parts.items():
            if name != UNKNOWN:
                found.setdefault(name, []).append(_turns(run.name, np.concatenate(of)))
    return found


def _block_means(stamps_s: FloatArray, columns: FloatArray) -> FloatArray:
    """Means (K, 3) over blocks of BLOCK_S of the rows (N, 3) that are whole."""
    whole = np.isfinite(columns).all(axis=1)
    blocks = ((stamps_s - stamps_s[0]) / BLOCK_S).astype(np.int64)[whole]
    counts = np.bincount(blocks)
    sums = np.column_stack([np.bincount(blocks, column) for column in columns[whole].T])
    return np.asarray(sums[counts > 0] / counts[counts > 0, None]).reshape(-1, 3)


def _without_speed(means: FloatArray) -> FloatArray:
    """Difference of the treads and yaw rate (K, 2), less what is constant or goes with the speed.

    A bias of the gyroscope, and a robot that is pulled to one side the more the faster it drives.
    """
    left, right, yaw_rate = means.T
    beside = np.column_stack([np.ones(len(means)), left + right])
    both = np.column_stack([right - left, yaw_rate])
    return np.asarray(both - beside @ np.linalg.lstsq(beside, both)[0])


def _turns(run: str, means: FloatArray) -> DriveTurns:
    difference, yaw_rate = means.T
    information = float(difference @ difference)
    gain = float(difference @ yaw_rate) / information if information > 0 else np.nan
    left = yaw_rate - np.nan_to_num(gain) * difference
    return DriveTurns(run, gain, information, float(left @ left), len(means))


def with_unknown_turns(turns: Mapping[str, Sequence[DriveTurns]]) -> tuple[str, ...]:
    """Names of the terrains whose runs do not show by how much the treads turn the robot.

    They go straight on, or all their turns are of one speed and radius: the yaw rate is then that
    of any gain beside a bias of the gyroscope.
    """
    return tuple(
        name
        for name, of in turns.items()
        if max(map(_sigmas, (of, *([one] for one in of)))) < LEAST_SIGMAS
    )


def turn_notes(turns: Mapping[str, Sequence[DriveTurns]]) -> Iterator[str]:
    """Sentences of terrains that hardly turn, and of drives that turn against their treads.

    And of those that turn as another terrain does.
    """
    unknown = with_unknown_turns(turns)
    for name in unknown:
        yield (
            f"The runs of {name} hardly turn, or turn alike all the time: by how much its treads "
            "turn the robot is not known, and names beside it say little. Record turns to both "
            "sides, or leave it out."
        )
    determined = {
        name: [one for one in of if _sigmas([one]) >= LEAST_SIGMAS]
        for name, of in turns.items()
        if name not in unknown
    }
    found = [
        _reversed(name, one) or _contradiction(name, one, determined)
        for name, of in determined.items()
        for one in of
    ]
    said = [words for words in found if words]
    yield from said[:MOST_NOTES]
    if len(said) > MOST_NOTES:
        yield f"Further drives of which the same is true: {len(said) - MOST_NOTES}."


def _sigmas(of: Sequence[DriveTurns]) -> float:
    """By how many standard deviations the common gain of drives differs from 0."""
    turning = [one for one in of if one.information > 0]
    information = sum(one.information for one in turning)
    if not turning:
        return 0.0
    gain = sum(one.gain_rad_m * one.information for one in turning) / information
    left = sum(one.left + (gain - one.gain_rad_m) ** 2 * one.information for one in turning)
    freedom = max(sum(one.blocks - 1 for one in of), 1)
    return abs(gain) / float(np.sqrt(max(left / freedom / information, 1e-18)))


def _reversed(name: str, one: DriveTurns) -> str:
    """In words, if a drive turns to the other side than its treads do."""
    if one.gain_rad_m > 0:
        return ""
    return (
        f"{one.run}, named {name}, turns the robot against its treads ({one.gain_rad_m:.3f} "
        "rad/m): are v_left and v_right exchanged, or is the gyroscope reversed? Run `check` on it."
    )


def _contradiction(
    name: str, one: DriveTurns, determined: Mapping[str, Sequence[DriveTurns]]
) -> str:
    """In words, if a drive turns as one of another terrain, and unlike those of its own."""
    own = [of for of in determined[name] if of is not one]
    if not own:
        return ""
    others = [(of, other) for other, rest in determined.items() if other != name for of in rest]
    nearest_own = min(own, key=lambda of: abs(of.gain_rad_m - one.gain_rad_m))
    apart = abs(nearest_own.gain_rad_m - one.gain_rad_m)
    near = [(abs(of.gain_rad_m - one.gain_rad_m), other, of) for of, other in others]
    certain = SIGMAS * np.hypot(one.sigma_rad_m, nearest_own.sigma_rad_m)
    if not near or apart < max(LEAST_APART * one.gain_rad_m, certain):
        return ""
    distance, other, of = min(near, key=lambda row: row[0])
    if distance > NEARER * apart:
        return ""
    return (
        f"{one.run}, named {name}, turns the robot by {one.gain_rad_m:.3f} rad/m, nearer to "
        f"{of.run} of {other} ({of.gain_rad_m:.3f}) than to any other drive of {name} "
        f"({nearest_own.run}: {nearest_own.gain_rad_m:.3f}). Is its terrain named rightly, with "
        f"the robot, tyres and units of the others? If so, turns do not distinguish {name} and "
        f"{other}: `modes` may name one of them for the other."
    )
