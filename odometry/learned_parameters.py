"""What a replay has learned, as a parameter set for the next run."""

from dataclasses import replace

import numpy as np

from odometry.estimates import Replay
from odometry.estimation.estimate import IcrBelief
from odometry.models.catalogue import ICR_NAMES
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.run import UNKNOWN

MUCH_SURER = 2.0  # times less variance


def learned_parameters(
    before: ParameterSet, replay: Replay, run_name: str, track_width_m: float | None = None
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
    track_width_m : float, optional
        Of the robot: [vehicle] gets it, where it has none.
    """
    terrains = dict(before.terrains)
    names, astride, accepted = np.array(replay.terrains), replay.is_astride, replay.accepted
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
    robot = {} if track_width_m is None else {"track_width": track_width_m}
    return ParameterSet(terrains, robot | dict(before.vehicle))


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
