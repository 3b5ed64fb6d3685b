"""Names of the models, and which parameters each has.

Examples
--------
>>> import odometry
>>> list(odometry.MODELS)[:3]
['differential_drive', 'icr_symmetric', 'icr']
>>> [parameter.name for parameter in odometry.MODELS["icr"].parameters]
['y_left', 'y_right', 'x_icr', 'alpha_left', 'alpha_right']
"""

from odometry.errors import ParameterError
from odometry.models.base import KinematicModel
from odometry.models.contact import Contact
from odometry.models.icr import Icr
from odometry.models.icr_inertia import IcrInertia, IcrInertiaMeasured
from odometry.models.icr_slope import IcrSlope
from odometry.models.radius_of_curvature import FullLinear, RadiusOfCurvature
from odometry.models.symmetric import DifferentialDrive, IcrSymmetric, TractionMode

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
        Contact(),
    )
}

ICR_NAMES = ("y_left", "y_right", "x_icr", "alpha_left", "alpha_right")

# The names that a parameter set may hold.
PARAMETER_NAMES: dict[str, tuple[str, ...]] = {
    name: tuple(parameter.name for parameter in model.parameters) for name, model in MODELS.items()
}

OPTIONAL_NAMES = frozenset({"alpha_left", "alpha_right"})  # 1 when absent


def model_named(name: str) -> KinematicModel:
    """The model of a name.

    Raises
    ------
    ParameterError
        If there is none.

    Examples
    --------
    >>> import odometry
    >>> odometry.model_named("icr_symmetric").parameters[0].name
    'alpha'
    """
    if name not in MODELS:
        raise ParameterError(f"there is no model {name!r}; known: {', '.join(MODELS)}")
    return MODELS[name]
