"""Names of the models: which parameters each has, and which are implemented here."""

from odometry.models.base import KinematicModel
from odometry.models.icr import Icr
from odometry.models.symmetric import DifferentialDrive, IcrSymmetric

MODELS: dict[str, KinematicModel] = {
    model.name: model for model in (DifferentialDrive(), IcrSymmetric(), Icr())
}

ICR_NAMES = ("y_left", "y_right", "x_icr", "alpha_left", "alpha_right")

# Names that a parameter set may hold, so that a set identified elsewhere can be read: those of
# the models above, and those of models that CONVENTIONS names and nothing here computes yet.
PARAMETER_NAMES: dict[str, tuple[str, ...]] = {
    **{name: tuple(p.name for p in model.parameters) for name, model in MODELS.items()},
    "radius_of_curvature": ("alpha", "beta_1", "beta_2", "track_width"),
    "full_linear": tuple(f"gamma_{row}{column}" for row in (1, 2, 3) for column in (1, 2)),
    "icr_slope": (*ICR_NAMES, "lambda_1", "lambda_2", "v_max", "half_width", "half_length"),
    "icr_inertia": (
        *("zeta_0", "zeta_1", "epsilon_0", "epsilon_1", "eta_0", "eta_1", "eta_2", "h"),
        *("mass", "x_cm", "y_cm", "track_width"),
    ),
    "traction_mode": ("k", "m", "track_width"),
    "contact": (
        *("mu", "mass", "x_cm", "y_cm", "height", "half_length", "half_width"),
        *("contacts", "slip_scale"),
    ),
}

OPTIONAL_NAMES = frozenset({"alpha_left", "alpha_right"})  # 1 when absent
