"""What a replay has learned, as a parameter set for the next run."""

from dataclasses import replace

import numpy as np

from odometry.estimation.estimate import Estimate, IcrBelief
from odometry.models.catalogue import ICR_NAMES
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.replay import Replay
from odometry.run import UNKNOWN

MUCH_SURER = 2.0  # times less variance


def learned_parameters(before: ParameterSet, replay: Replay, run_name: str) -> ParameterSet:
    """The parameter set with the ICRs that the filter held when it last left each terrain.

    Effects stay as they were.

    Parameters
    ----------
    before : ParameterSet
        Terrains where no pose was taken in keep their tables, and so does one that was left
        before the filter knew it about as well as its table states.
    replay : Replay
    run_name : str
        Named as the source.
    """
    terrains = dict(before.terrains)
    for name in dict.fromkeys(replay.terrains):
        if name == UNKNOWN:
            continue
        there = [
            estimate
            for estimate in replay.estimates
            if estimate.terrain == name and estimate.crossing is None
        ]
        poses = sum(_took_pose(estimate) for estimate in there)
        if poses and not _is_much_surer(before.terrains.get(name), there[-1].belief):
            source = f"learned by terrain-odometry from {poses} poses of {run_name}"
            effects = before.terrains[name].effects if name in before.terrains else ()
            terrains[name] = replace(_table(there[-1].belief, source), effects=effects)
    return ParameterSet(terrains, before.vehicle)


def _is_much_surer(table: TerrainParameters | None, belief: IcrBelief) -> bool:
    """Whether a table states less than half the variance of the ICRs."""
    if table is None or not set(ICR_NAMES[:3]) <= set(table.covariance_order):
        return False
    stated = float(np.trace(table.covariance_of(ICR_NAMES[:3])))
    return MUCH_SURER * stated < float(np.trace(belief.covariance[:3, :3]))


def _took_pose(estimate: Estimate) -> bool:
    return estimate.innovation is not None and estimate.innovation.accepted


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
