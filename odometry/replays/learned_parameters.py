"""What replays have learned, of one run and of several, as a parameter set for the next run."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2

from odometry.arrays import FloatArray
from odometry.estimation.estimate import IcrBelief
from odometry.models.catalogue import ICR_NAMES
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.run import UNKNOWN, Robot
from odometry.replays.estimates import Replay
from odometry.replays.random_effects import (
    between_run_variance,
    dissent,
    largest_between_run_variance,
)
from odometry.set_of_robot import other_width

MUCH_SURER = 2.0  # times less variance


def learned_parameters(
    before: ParameterSet, replay: Replay, run_name: str, robot: Robot | None = None
) -> ParameterSet:
    """The parameter set with the ICRs that the filter held when it last left each terrain.

    Effects stay as they were.

    Parameters
    ----------
    before : ParameterSet
        Terrains where no pose was taken in keep their tables, and so does one that was left
        before the filter knew it about as well as its table states. One without a table gets
        none unless the filter came to know much more of its ICRs than at the start there: a
        stationary robot, or one that drives straight on, gives no information on them.
    replay : Replay
    run_name : str
        Named as the source.
    robot : Robot, optional
        [vehicle] gets its track width, where it has none. Of a set of another robot only what was
        learned is handed on.
    """
    of_another_robot = robot is not None and bool(other_width(before, robot))
    terrains = {} if of_another_robot else dict(before.terrains)
    names, astride, accepted = (
        np.array(replay.terrains, dtype=object),
        replay.is_astride,
        replay.accepted,
    )
    for name in dict.fromkeys(replay.terrains):
        if name == UNKNOWN:
            continue
        there = np.flatnonzero((names == name) & ~astride)
        poses = int(accepted[there].sum())
        if not poses:
            continue
        came, left = (replay.estimates[int(there[place])].belief for place in (0, -1))
        if _is_worth_keeping(before.terrains.get(name), came, left):
            source = f"learned by terrain-odometry from {poses} poses of {run_name}"
            effects = before.terrains[name].effects if name in before.terrains else ()
            terrains[name] = replace(_table(left, source), effects=effects)
    own = {} if robot is None else {"track_width": robot.track_width}
    return ParameterSet(terrains, own if of_another_robot else own | dict(before.vehicle))


def _is_worth_keeping(table: TerrainParameters | None, came: IcrBelief, left: IcrBelief) -> bool:
    """Whether the filter left a terrain knowing its ICRs better than a table, or than it came."""
    if table is None:
        return MUCH_SURER * _icr_variance(left) < _icr_variance(came)
    if not set(ICR_NAMES[:3]) <= set(table.covariance_order):
        return True
    return MUCH_SURER * float(np.trace(table.covariance_of(ICR_NAMES[:3]))) >= _icr_variance(left)


def _icr_variance(belief: IcrBelief) -> float:
    return float(np.trace(belief.covariance[:3, :3]))


def _table(belief: IcrBelief, source: str) -> TerrainParameters:
    values = [*belief.icrs.tolist(), *belief.alphas.tolist()]
    learned = np.flatnonzero(np.diag(belief.covariance))  # slip factors may be held as given
    return TerrainParameters(
        "icr",
        dict(zip(ICR_NAMES, values, strict=True)),
        tuple(ICR_NAMES[k] for k in learned),
        ((belief.covariance + belief.covariance.T) / 2)[np.ix_(learned, learned)],
        source,
    )


FEWEST = 3  # runs from which a spread can be estimated
FAR = 5.7e-7  # probability: five standard deviations of a normal distribution, both sides
UNITS = dict.fromkeys(ICR_NAMES[:3], " m")


@dataclass(frozen=True)
class MergedTerrain:
    """One terrain of several runs.

    Attributes
    ----------
    runs : tuple of str
        Which learned it.
    parameters : TerrainParameters
        Their mean; its covariance is of a next run there, the spread between runs included at its
        upper limit.
    spread : Mapping of parameter to float
        Standard deviation of the true values between runs, as estimated; empty where it cannot be
        estimated.
    disagree : tuple of str
        Sentences on runs that lie far from the others.
    """

    runs: tuple[str, ...]
    parameters: TerrainParameters
    spread: Mapping[str, float]
    disagree: tuple[str, ...]


def learned_by_runs(
    before: ParameterSet, after: Mapping[str, ParameterSet]
) -> dict[str, dict[str, TerrainParameters]]:
    """Tables by terrain and run that a run changed; those handed on as they were are left out.

    Parameters
    ----------
    before : ParameterSet
        With which every run began.
    after : Mapping of run to ParameterSet
        What each left.
    """
    found: dict[str, dict[str, TerrainParameters]] = {}
    for run, learned in after.items():
        for terrain, table in learned.terrains.items():
            if not _is_same(table, before.terrains.get(terrain)):
                found.setdefault(terrain, {})[run] = table
    return found


def merged_terrain(
    tables: Mapping[str, TerrainParameters], *, began_alike: bool = False
) -> MergedTerrain:
    """Merge the tables of one terrain.

    The mean weighs each run with the inverse of its covariance plus the spread between runs, and
    the covariance is of a next run. Both take the spread at its upper limit, for each parameter
    apart: that of two runs cannot be estimated, and is wide. One run's table stays as it is.

    Parameters
    ----------
    tables : Mapping of run to TerrainParameters
        As the ICR filter leaves them: the model `icr`, a covariance of the same parameters.
    began_alike : bool
        Whether the runs began with the same table: their errors may then be correlated, and the
        mean is taken for no surer than one run of mean certainty.

    References
    ----------
    DerSimonian and Laird 1986, eq. 8 to 10; Viechtbauer 2007, section 3.2. Julier and Uhlmann
    1997, "A non-divergent estimation algorithm in the presence of unknown correlations", eq. 2
    and 3, with equal weights.
    """
    runs, of = tuple(tables), list(tables.values())
    if len(of) == 1:
        return MergedTerrain(runs, of[0], {}, ())
    names = tuple(name for name in of[0].covariance_order if name in ICR_NAMES)
    values = np.array([[table.values[name] for name in names] for table in of])
    covariances = np.array([table.covariance_of(names) for table in of])
    variances = np.diagonal(covariances, axis1=1, axis2=2)
    columns = list(zip(values.T, variances.T, strict=True))
    between = np.array([largest_between_run_variance(*column) for column in columns])
    weights = np.linalg.pinv(covariances + np.diag(between), hermitian=True)
    of_mean = np.linalg.pinv(weights.sum(axis=0), hermitian=True)
    mean = of_mean @ np.einsum("kij,kj->i", weights, values)
    factor = len(of) if began_alike else 1
    covariance = np.diag(between) + factor * of_mean
    merged = replace(
        of[0],
        values={**of[0].values, **dict(zip(names, mean.tolist(), strict=True))},
        covariance_order=names,
        covariance=(covariance + covariance.T) / 2,
        source=f"merged by terrain-odometry from what {len(of)} runs learned",
    )
    spread = (
        {}
        if len(of) < FEWEST
        else {
            name: float(np.sqrt(between_run_variance(*column)))
            for name, column in zip(names, columns, strict=True)
        }
    )
    return MergedTerrain(runs, merged, spread, _disagree(runs, names, values, covariances))


def _disagree(
    runs: Sequence[str], names: Sequence[str], values: FloatArray, covariances: FloatArray
) -> tuple[str, ...]:
    if len(runs) < FEWEST:
        return _pair_disagrees(runs, values, covariances)
    found = []
    for row, run in enumerate(runs):
        for column, name in enumerate(names):
            far = dissent(values[:, column], covariances[:, column, column], row)
            if far.probability < FAR:
                unit = UNITS.get(name, "")
                found.append(
                    f"{run}: {name} {values[row, column]:.3f}{unit}, the other {len(runs) - 1} "
                    f"runs {far.others:.3f}{unit}: {far.sigmas:.0f} standard deviations apart"
                )
    return tuple(found)


def _pair_disagrees(
    runs: Sequence[str], values: FloatArray, covariances: FloatArray
) -> tuple[str, ...]:
    apart = values[1] - values[0]
    squared = float(apart @ np.linalg.pinv(covariances.sum(axis=0), hermitian=True) @ apart)
    if chi2.sf(squared, len(apart)) >= FAR:
        return ()
    return (
        f"{runs[0]} and {runs[1]} disagree far beyond their covariances; which of them is right "
        "cannot be estimated",
    )


def _is_same(table: TerrainParameters, before: TerrainParameters | None) -> bool:
    return (
        before is not None
        and table.source == before.source
        and dict(table.values) == dict(before.values)
        and table.covariance_order == before.covariance_order
        and np.array_equal(table.covariance, before.covariance)
    )
