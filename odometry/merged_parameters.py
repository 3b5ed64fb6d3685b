"""What several runs learned, as one parameter set for the next run."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2

from odometry.arrays import FloatArray
from odometry.models.catalogue import ICR_NAMES
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.random_effects import (
    between_run_variance,
    dissent,
    largest_between_run_variance,
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
    alike = len(of) if began_alike else 1
    covariance = np.diag(between) + alike * of_mean
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
