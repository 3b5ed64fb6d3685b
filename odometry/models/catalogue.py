"""Names of the models, and which parameters each has."""

from odometry.errors import ParameterError
from odometry.models.base import KinematicModel
from odometry.models.full_linear import FullLinear
from odometry.models.icr import Icr
from odometry.models.icr_inertia import IcrInertia
from odometry.models.icr_inertia_measured import IcrInertiaMeasured
from odometry.models.icr_slope import IcrSlope
from odometry.models.radius_of_curvature import RadiusOfCurvature
from odometry.models.symmetric import DifferentialDrive, IcrSymmetric
from odometry.models.traction_mode import TractionMode

MODELS: dict[str, KinematicModel] = {
    model.name: model
    for model in (
        DifferentialDrive(),
        IcrSymmetric(),
        Icr(),
        RadiusOfCurvature(),
        FullLinear(),
        IcrSlope(),
        IcrInertia(),
        IcrInertiaMeasured(),
        TractionMode(),
    )
}

ICR_NAMES = ("y_left", "y_right", "x_icr", "alpha_left", "alpha_right")

# Names that a parameter set may hold, so that a set identified elsewhere can be read.
PARAMETER_NAMES: dict[str, tuple[str, ...]] = {
    **{name: tuple(p.name for p in model.parameters) for name, model in MODELS.items()},
    "contact": (
        *("mu", "mass", "x_cm", "y_cm", "height", "half_length", "half_width"),
        *("contacts", "slip_scale"),
    ),
}

OPTIONAL_NAMES = frozenset({"alpha_left", "alpha_right"})  # 1 when absent


def model_named(name: str) -> KinematicModel:
    """The model of a name.

    Raises
    ------
    ParameterError
        If there is none.
    """
    if name not in MODELS:
        raise ParameterError(f"there is no model {name!r}; known: {', '.join(MODELS)}")
    return MODELS[name]
