"""A model with fewer parameters, where the runs determine these and not all of the model's."""

from dataclasses import replace

from odometry.effects.tables import effects_of
from odometry.errors import OdometryError
from odometry.identification.config import SolverConfig
from odometry.identification.fitters import fitter
from odometry.identification.identification import Identification
from odometry.models.catalogue import MODELS

SIMPLE = "icr_symmetric"  # two factors: a scale and an effective width


def simpler_model(found: Identification) -> Identification | None:
    """`SIMPLE` on the same windows, where a refused identification left parameters open.

    None where the identified model does not explain the runs, has effects or is as simple, or
    where the runs do not determine this one either. Nothing is held out.
    """
    models = [one.fit.model for one in found.terrains.values()]
    if found.unexplained or any(model.name == SIMPLE or effects_of(model) for model in models):
        return None
    fit_to = fitter(
        MODELS[SIMPLE],
        found.robot,
        fixed={},
        window_config=found.window_config,
        solver_config=SolverConfig(),
    )
    try:
        terrains = {
            terrain: replace(one, fit=fit_to(one.fit.windows), held_out=None, given={})
            for terrain, one in found.terrains.items()
        }
        simpler = replace(found, terrains=terrains)
        simpler.require_determined()
    except OdometryError:
        return None
    return simpler
