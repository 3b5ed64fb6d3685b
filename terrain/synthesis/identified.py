"""A parameter set as an identification run would have left it: near the truth, not the truth."""

from collections.abc import Mapping

import numpy as np

from odometry.arrays import FloatArray
from odometry.parameters import ParameterSet, TerrainParameters
from terrain.synthesis.config import SynthesisConfig

NAMES = ("y_left", "y_right", "x_icr")


def identified_parameters(
    config: SynthesisConfig, true_icrs_m: Mapping[str, FloatArray], rng: np.random.Generator
) -> ParameterSet:
    """Truth plus noise of the stated sigma, in the order of `true_icrs_m`.

    Parameters
    ----------
    config : SynthesisConfig
        For its `sigma_parameters_m` and robot.
    true_icrs_m : mapping of terrain to (3,) array
        y_left, y_right, x_icr [m].
    rng : numpy.random.Generator
        Source of the noise.
    """
    sigma = np.array(config.sigma_parameters_m)
    stated = ", ".join(f"{s:g}" for s in sigma)
    source = f"synthetic truth plus noise of sigma {stated} m, as from an identification run"
    terrains = {
        name: TerrainParameters(
            model="icr",
            values={
                key: round(float(value), 4)
                for key, value in zip(NAMES, icr + sigma * rng.standard_normal(3), strict=True)
            },
            covariance_order=NAMES,
            covariance=np.diag(sigma**2),
            source=source,
        )
        for name, icr in true_icrs_m.items()
    }
    vehicle = {
        "name": str(config.robot.get("name", "robot")),
        "source": "terrain-odometry synthesise",
    }
    return ParameterSet(terrains, vehicle)
