"""Every model is identified from a drive by itself."""

import numpy as np
import pytest

from odometry.identification.fitters import fitter
from odometry.identification.start import SolverConfig
from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.travel.windows import windows_of

ONE_START = SolverConfig(starts=1)
ICE = {"y_left": 0.7, "y_right": -0.6, "x_icr": -0.05, "alpha_left": 0.8, "alpha_right": 0.9}
TRUTHS = {
    "icr_symmetric": {"alpha": 0.93, "b_hat": 0.8},
    "icr": ICE,
    "radius_of_curvature": {"alpha": 0.95, "beta_1": 1.2, "beta_2": 0.7, "track_width": 0.5},
    "full_linear": {
        "gamma_11": 0.47,
        "gamma_12": 0.44,
        "gamma_21": -0.12,
        "gamma_22": 0.16,
        "gamma_31": -1.1,
        "gamma_32": 1.2,
    },
    "icr_slope": {
        **ICE,
        "lambda_1": 1.4,
        "lambda_2": 3.0,
        "v_max": 1.2,
        "half_width": 0.25,
        "half_length": 0.35,
    },
    "traction_mode": {"k": 0.93, "m": 0.6, "track_width": 0.5},
    "contact": {
        "mu": 0.5,
        "mass": 50.0,
        "x_cm": 0.04,
        "y_cm": -0.02,
        "height": 0.25,
        "half_length": 0.3,
        "half_width": 0.25,
        "contacts": 2.0,
        "slip_scale": 0.04,
    },
}
UNTESTED = {"differential_drive": "it has no parameter to identify"}


@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
def test_every_model_comes_back_without_noise(model, synthetic, tmp_path):
    """Driven by the model itself over flat and rolling ground, integrated by the plain loop."""
    if model.name in UNTESTED:
        pytest.skip(f"{model.name}: {UNTESTED[model.name]}")
    truths = TRUTHS | dict.fromkeys(("icr_inertia", "icr_inertia_measured"), synthetic.inertia)
    if model.name not in truths:
        pytest.skip(f"{model.name}: no parameters are written here to drive it by")
    truth, rng = truths[model.name], np.random.default_rng(4)
    odometry = synthetic.commands(rng, 500)
    stamps_s = odometry[:, 0]
    odometry = np.column_stack([odometry, rng.uniform(-2, 2, (len(odometry), 2))])
    rolling = (stamps_s > 25)[:, None] * np.stack([np.sin(stamps_s), np.cos(0.7 * stamps_s)], 1)
    inputs = Inputs(odometry[:, 1:3], *0.2 * rolling.T, odometry[:, 3:])
    folder = synthetic.write(
        tmp_path / "run",
        odometry,
        np.arange(0, 49.5, 0.3),
        synthetic.in_order(model.twist(model.pack(truth), inputs)),
        attitude_of=synthetic.in_order(0.2 * rolling),
    )
    run, config = Run.read(folder), WindowConfig(horizon_m=1.0)
    known = {p.name: truth[p.name] for p in model.parameters if p.known}
    fit_to = fitter(model, run.robot, fixed=known, window_config=config, solver_config=ONE_START)
    found = fit_to(windows_of([run], config))
    told = {name: value for name, value in truth.items() if name not in found.by_trial}
    assert {name: found.values[name] for name in told} == pytest.approx(told, rel=1e-6, abs=1e-7)
    assert found.undetermined == ()
    assert found.scale < 1e-4
