"""What a replay has learned, as a parameter set for the next run."""

from odometry.estimation.estimate import Estimate, IcrBelief
from odometry.models.catalogue import ICR_NAMES
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.pipeline import Replay


def learned_parameters(before: ParameterSet, replay: Replay, run_name: str) -> ParameterSet:
    """The parameter set with the ICRs that the filter held when it last left each terrain.

    Parameters
    ----------
    before : ParameterSet
        Terrains where no pose was taken in keep their tables.
    replay : Replay
    run_name : str
        Named as the source.
    """
    terrains = dict(before.terrains)
    for name in dict.fromkeys(replay.terrains):
        there = [estimate for estimate in replay.estimates if estimate.terrain == name]
        poses = sum(_took_pose(estimate) for estimate in there)
        if poses:
            source = f"learned by terrain-odometry from {poses} poses of {run_name}"
            terrains[name] = _table(there[-1].belief, source)
    return ParameterSet(terrains, before.vehicle)


def _took_pose(estimate: Estimate) -> bool:
    return estimate.innovation is not None and estimate.innovation.accepted


def _table(belief: IcrBelief, source: str) -> TerrainParameters:
    values = [*belief.icrs.tolist(), *belief.alphas.tolist()]
    return TerrainParameters(
        "icr",
        dict(zip(ICR_NAMES, values, strict=True)),
        ICR_NAMES[:3],
        (belief.covariance + belief.covariance.T) / 2,
        source,
    )
