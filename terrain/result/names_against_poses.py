"""Whether poses fit one terrain throughout better than those that the camera named."""

import shlex
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.tables import model_of
from odometry.windows.travel.motion import window_motion
from odometry.windows.travel.motion_ratios import HORIZON_M
from odometry.windows.travel.windows import Windows
from terrain.result.run_result import RunResult
from terrain.result.sets_against_poses import windows_in_force

FEWEST_STRETCHES = 5  # of one terrain in force each: windows of one stretch are right together
CERTAIN = 3.0  # standard deviations
WORTH_SAYING = 1.1  # times as large an error


@dataclass(frozen=True)
class NamesAgainstPoses:
    """Errors of the motion by the parameters of the named terrains, and of one terrain alone.

    Attributes
    ----------
    terrain : str
        The one whose parameters fit all named windows best.
    windows, stretches : int
    named_m, alone_m : float
        Mean over windows of `HORIZON_M` [m].
    certainty : float
        How many standard deviations the errors of the names are the larger ones.
    """

    terrain: str
    windows: int
    stretches: int
    named_m: float
    alone_m: float
    certainty: float

    @property
    def is_worse(self) -> bool:
        """Whether the names surely describe the motion worse than one terrain does."""
        return self.certainty > CERTAIN and self.named_m > WORTH_SAYING * self.alone_m


def names_against_poses(result: RunResult) -> NamesAgainstPoses | None:
    """The terrains in force against each of them alone; None where too little is compared."""
    windows = windows_in_force(result)
    names = list(result.parameters.terrains)
    if windows is None or len(names) < 2:
        return None
    is_named = np.isin(windows.terrain, names)
    changes = windows.terrain[1:] != windows.terrain[:-1]
    stretches = np.append(0, np.cumsum(changes))[is_named]
    windows = windows.where(is_named)
    if len(np.unique(stretches)) < FEWEST_STRETCHES:
        return None
    errors_m = np.array([_errors_m(result, name, windows) for name in names])
    codes = [names.index(name) for name in windows.terrain]
    named_m = errors_m[codes, np.arange(len(windows))]
    best = int(errors_m.mean(axis=1).argmin())
    return NamesAgainstPoses(
        names[best],
        len(windows),
        len(np.unique(stretches)),
        float(named_m.mean()),
        float(errors_m[best].mean()),
        certainty_of(named_m - errors_m[best], stretches),
    )


def names_note(result: RunResult) -> list[str]:
    """Say that the camera makes the odometer worse, where poses show it."""
    found = None if result.watcher is None else names_against_poses(result)
    if found is None or not found.is_worse:
        return []
    terrain = shlex.quote(found.terrain)
    return [
        f"by the poses the terrains that the camera named describe the motion worse than "
        f"{found.terrain!r} alone: over {HORIZON_M:g} m their parameters are off by "
        f"{found.named_m:.3f} m, its own by {found.alone_m:.3f} m ({found.windows} windows). The "
        f"odometer is worse with the camera than without: --no-vision --terrain {terrain}. Names "
        "may be wrong (train with images of this camera), or the parameters are of another weather"
    ]


def _errors_m(result: RunResult, name: str, windows: Windows) -> FloatArray:
    """Errors (K,) of displacements by one terrain's parameters [m].

    With a gyroscope, which turns the odometer, displacements are taken from the middle heading,
    so that the turns of the parameters hardly count.
    """
    table = result.parameters.terrains[name]
    model = model_of(table, result.run.robot, f"terrain {name!r}")
    predicted = window_motion(model, model.pack(table.values), windows)
    measured = windows.measured
    if result.run.yaw_rate is not None:
        predicted, measured = _from_middle(predicted), _from_middle(measured)
    return np.asarray(np.hypot(*(predicted - measured)[:, :2].T))


def _from_middle(motion: FloatArray) -> FloatArray:
    """Displacements (K, 3) in the frame of the heading half way."""
    cosine, sine = np.cos(motion[:, 2] / 2), np.sin(motion[:, 2] / 2)
    x, y = motion[:, 0], motion[:, 1]
    return np.column_stack([cosine * x + sine * y, cosine * y - sine * x, motion[:, 2]])


def certainty_of(differences: FloatArray, stretches: FloatArray) -> float:
    """Mean of differences (K,) over its standard deviation, by leaving out each stretch once."""
    numbers = np.unique(stretches, return_inverse=True)[1]
    sums, counts = np.bincount(numbers, differences), np.bincount(numbers)
    means = (sums.sum() - sums) / (counts.sum() - counts)
    spread = np.sqrt((len(means) - 1) * np.var(means))
    return float(differences.mean() / max(spread, 1e-12))
