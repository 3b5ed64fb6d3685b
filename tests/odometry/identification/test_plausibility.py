"""What is refused at a bound, what is only noted, and what is neither."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import IdentificationError
from odometry.identification.fitted import Undetermined
from odometry.identification.identify import identify
from odometry.identification.plausibility import notes, refusals
from odometry.identification.start import SolverConfig
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig

CONFIG = WindowConfig(horizon_m=1.0)


def with_speeds_times(run, factor):
    columns = dict(run.odometry.columns)
    for name in ("v_left", "v_right"):
        columns[name] = columns[name] * factor
    return replace(run, odometry=replace(run.odometry, columns=columns))


def identified(run, model="icr", config=CONFIG):
    return identify([run], model, window_config=config, solver_config=SolverConfig(starts=2))


@pytest.mark.parametrize(("model", "name"), [("icr", "alpha_left"), ("icr_symmetric", "alpha")])
def test_speeds_a_third_of_the_true_are_refused(winding, model, name):
    config = replace(CONFIG, horizon_m=1 / 3)
    found = identified(with_speeds_times(winding, 1 / 3), model, config)
    with pytest.raises(IdentificationError) as caught:
        found.require_determined()
    message = str(caught.value)
    assert f"[gravel] {name} ended at its bound 2" in message
    scale = found.terrains["gravel"].fit.scale
    assert f"{scale:.1f} times the poses' stated noise" in message
    assert "another unit" in message


def test_swapped_treads_are_refused(winding):
    columns = dict(winding.odometry.columns)
    columns["v_left"], columns["v_right"] = columns["v_right"], columns["v_left"]
    run = replace(winding, odometry=replace(winding.odometry, columns=columns))
    with pytest.raises(IdentificationError):
        identified(run, "icr_symmetric").require_determined()


def test_positions_in_kilometres_are_refused_though_residuals_are_small(winding):
    columns = dict(winding.pose.columns)
    columns |= {name: columns[name] / 1000 for name in ("x", "y")}
    run = replace(winding, pose=replace(winding.pose, columns=columns))
    found = identified(run, "icr_symmetric")
    assert found.terrains["gravel"].fit.scale < 3
    with pytest.raises(
        IdentificationError, match=r"alpha is 0\.00\d+, and slip leaves 0\.3 to 1\.5"
    ):
        found.require_determined()


def test_gains_that_slip_does_not_make_are_doubted(winding):
    """Speeds 0.6 of the true: 1.6 is within the bounds, and no slip."""
    found = identified(with_speeds_times(winding, 0.6))
    found.require_determined()
    said = notes(found.terrains["gravel"].fit)
    assert [words.split(" =")[0] for words in said] == ["alpha_left", "alpha_right"]
    assert "are the tread speeds in m/s?" in said[0]
    assert notes(identified(winding).terrains["gravel"].fit) == ()


def test_at_its_bound_with_residuals_as_the_noise_explains_is_noted(synthetic, tmp_path):
    odometry = synthetic.commands(np.random.default_rng(3), 400)
    truth = synthetic.icrs | {"alpha_left": 2.02, "alpha_right": 1.4}
    folder = synthetic.write(tmp_path, odometry, np.arange(0, 39, 0.1), synthetic.icr_twist(truth))
    found = identified(Run.read(folder), config=WindowConfig(horizon_m=0.5))
    found.require_determined()
    (ground,) = found.terrains.values()
    assert ground.fit.at_bound == ("alpha_left",)
    assert any("alpha_left ended at the edge" in words for words in notes(ground.fit))
    open_ = (Undetermined({"alpha_left": 1.0}, np.inf),)
    assert not any("edge" in words for words in notes(replace(ground.fit, undetermined=open_)))


def test_a_bound_without_effect_is_an_answer(winding):
    """No widening by curvature: beta_2 = 0, whatever else the model lacks."""
    found = identified(winding, "radius_of_curvature", WindowConfig(yaw_sigma_rad=1e-4))
    fit = found.terrains["gravel"].fit
    assert fit.scale > 3
    neutral = replace(fit, at_bound=("beta_2",), values={**fit.values, "beta_2": 1e-4})
    assert refusals(neutral) == ()
    assert len(refusals(replace(neutral, values={**fit.values, "beta_2": 1e3}))) == 1


def test_few_degrees_of_freedom_are_said(winding):
    windows = WindowConfig(horizon_m=20.0)
    said = notes(identified(winding, config=windows).terrains["gravel"].fit)
    assert any("an interval rests on" in words for words in said)


def test_residuals_far_beyond_the_noise_are_said(winding):
    fit = identified(winding).terrains["gravel"].fit
    assert not any("most of the error" in words for words in notes(replace(fit, scale=4.9)))
    (said,) = notes(replace(fit, scale=14.2))
    assert said.startswith("the residuals are 14 times the poses' stated noise: most of the error")
