import numpy as np
import pytest

from odometry.identification.fit import fit
from odometry.identification.fitted import Undetermined, undetermined
from odometry.identification.start import SolverConfig
from odometry.models.catalogue import MODELS
from odometry.models.icr import Icr
from odometry.recording.run import Robot, Run
from odometry.windows.config import WindowConfig
from odometry.windows.travel.windows import windows_of

ROBOT = Robot(0.6, length=0.9, width=0.7, wheel_radius=0.15, mass=50.0)


@pytest.fixture
def excited_by(synthetic, tmp_path):
    """Fit `icr` to noisy poses of a minute of given speeds (callable of the row's time)."""

    def excited(speeds_at, fixed=None, count=600):
        stamps_s = np.arange(count) / 10
        odometry = np.array([(t, *speeds_at(t)) for t in stamps_s])
        twist_of = synthetic.icr_twist(synthetic.icrs | {"alpha_left": 1.0, "alpha_right": 1.0})
        folder = synthetic.write(tmp_path / "run", odometry, stamps_s[:-1:2], twist_of)
        run = synthetic.noisy(Run.read(folder), np.random.default_rng(9))
        config = WindowConfig(**synthetic.stated)
        windows = windows_of([run], config)
        return fit(
            Icr(),
            windows,
            run.robot,
            fixed=fixed or {},
            window_config=config,
            solver_config=SolverConfig(starts=1),
        )

    return excited


def named(fit):
    return {name for found in fit.undetermined for name in found.direction}


def test_a_straight_run_determines_the_slip_but_no_icr(excited_by):
    """Nothing turns: neither tread ICR shows, nor the one that both share."""
    found = excited_by(lambda _: (0.5, 0.5))
    assert named(found) == {"y_left", "y_right", "x_icr"}
    assert len(found.undetermined) == 3
    assert all(open_.deviation > 0.5 for open_ in found.undetermined)


def test_on_the_spot_slip_and_width_look_alike(excited_by):
    """Two numbers (drift forward, turn rate) for four parameters; x_icr alone is determined."""
    found = excited_by(lambda t: (-0.4, 0.4) if t % 20 < 10 else (0.4, -0.4))
    assert len(found.undetermined) == 2
    assert {"alpha_left", "alpha_right"} <= named(found)
    assert "x_icr" not in named(found)
    assert found.sigmas["x_icr"] < 0.01


def test_on_the_spot_the_icrs_are_determined_once_the_slip_is_fixed(excited_by):
    found = excited_by(
        lambda t: (-0.4, 0.4) if t % 20 < 10 else (0.4, -0.4),
        fixed={"alpha_left": 1.0, "alpha_right": 1.0},
    )
    assert found.undetermined == ()
    np.testing.assert_allclose(found.packed[:3], [0.45, -0.36, 0.06], atol=0.02)


def test_one_circle_only_leaves_something_open(excited_by):
    """Three numbers (forward, sideways, turn) do not determine five."""
    found = excited_by(lambda _: (0.3, 0.6))
    assert len(found.undetermined) == 2


def test_varied_turns_leave_nothing_open(excited_by):
    rng = np.random.default_rng(2)
    speeds = rng.uniform(-0.9, 1.1, (60, 2))
    assert excited_by(lambda t: speeds[int(t)]).undetermined == ()


def test_directions_are_those_of_the_inverse_normal_matrix(rng):
    """Eigenvectors of the covariance in units of the sizes, their deviations times the scale."""
    names, sizes = ("a", "b", "c", "d"), np.array([2.0, 0.01, 1.0, 30.0])
    jacobian = rng.normal(size=(40, 4)) * [1, 0.002, 0.05, 1e-4] / sizes
    scaled = jacobian * sizes
    variances, vectors = np.linalg.eigh(np.linalg.inv(scaled.T @ scaled))
    found = undetermined(jacobian, names, sizes, scale=1.5, largest=0.5)
    large = 1.5 * np.sqrt(variances) > 0.5
    assert 0 < large.sum() < 4
    deviations = [open_.deviation for open_ in found]
    np.testing.assert_allclose(sorted(deviations), 1.5 * np.sqrt(variances[large]), rtol=1e-9)
    for open_ in found:
        nearest = np.argmin(np.abs(1.5 * np.sqrt(variances) - open_.deviation))
        expected = dict(zip(names, vectors[:, nearest], strict=True))
        assert set(open_.direction) == {n for n, share in expected.items() if abs(share) >= 0.3}
        for name, share in open_.direction.items():
            assert abs(share) == pytest.approx(abs(expected[name]), rel=1e-6)


def test_a_larger_limit_leaves_less_open(rng):
    """Forty rows: deviations near 1 / sqrt(40) of 1, 10 and 100."""
    jacobian = rng.normal(size=(40, 3)) * [1.0, 0.1, 0.01]
    counts = [
        len(undetermined(jacobian, ("a", "b", "c"), np.ones(3), 1.0, largest))
        for largest in (0.05, 0.5, 5.0, 50.0)
    ]
    assert counts == [3, 2, 1, 0]


def test_what_has_no_derivative_is_open_without_end():
    jacobian = np.column_stack([np.zeros(9), np.arange(9.0)])
    (found,) = undetermined(jacobian, ("gone", "told"), np.ones(2), 1.0, 0.5)
    assert found.direction == {"gone": 1.0}
    assert found.deviation == np.inf


def test_two_that_only_show_together_are_named_together():
    """Only a - b shows: a + b is open."""
    rows = np.linspace(1, 9, 9)
    jacobian = np.column_stack([rows, -rows])
    (found,) = undetermined(jacobian, ("a", "b"), np.ones(2), 1.0, 0.5)
    assert found.direction == pytest.approx({"a": np.sqrt(0.5), "b": np.sqrt(0.5)})


def test_without_free_parameters_nothing_is_open():
    assert undetermined(np.empty((9, 0)), (), np.empty(0), 1.0, 0.5) == ()


@pytest.mark.parametrize(
    ("found", "words"),
    [
        (Undetermined({"mu": 1.0}, np.inf), "mu: the predicted motion does not depend on it"),
        (
            Undetermined({"h": 1.0}, 0.75),
            "h: standard deviation 0.75 of its ordinary size",
        ),
        (
            Undetermined({"y_left": 0.7, "y_right": -0.6}, 12.345),
            "+0.70 y_left -0.60 y_right: standard deviation 12 of its ordinary size",
        ),
    ],
)
def test_words_have_the_numbers(found, words):
    assert found.words() == words


@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
def test_sizes_are_positive_for_every_model(model):
    for robot in (Robot(0.6), ROBOT):
        sizes = model.ordinary_sizes(robot)
        assert sizes.shape == (len(model.parameters),)
        assert np.all(np.isfinite(sizes))
        assert np.all(sizes > 0)


def test_sizes_by_hand():
    """The guess; half the track width of a length; 1; what 1 m/s^2 on the mass is worth.

    And a quarter of a range that has two ends.
    """
    assert Icr().ordinary_sizes(ROBOT).tolist() == pytest.approx([0.45, 0.45, 0.3, 1, 1])
    linear = MODELS["full_linear"].ordinary_sizes(ROBOT)
    assert linear.tolist() == pytest.approx([0.5, 0.5, 1, 1, 1 / 0.9, 1 / 0.9])
    inertia = MODELS["icr_inertia"]
    names = [parameter.name for parameter in inertia.parameters]
    sizes = dict(zip(names, inertia.ordinary_sizes(ROBOT), strict=True))
    expected = {"zeta_0": 0.3, "zeta_1": 0.3 / 50, "epsilon_1": 0.3 / 50}
    expected |= {"eta_0": 1.5, "eta_1": 1 / 50, "eta_2": 1 / 2500}
    assert {name: sizes[name] for name in expected} == pytest.approx(expected)
    contact = MODELS["contact"]
    place = [parameter.name for parameter in contact.parameters].index("x_cm")
    low, high = contact.parameters[place].search
    assert contact.ordinary_sizes(ROBOT)[place] == pytest.approx((high - low) / 4)
