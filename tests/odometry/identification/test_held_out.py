from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.identification.fit import fit
from odometry.identification.halves import by_halves, by_runs, held_out_errors
from odometry.identification.start import SolverConfig
from odometry.models.icr import Icr
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.travel.windows import windows_of
from odometry.windows.window_errors import window_errors

WIDE = {"y_left": 0.7, "y_right": -0.6, "x_icr": 0.0, "alpha_left": 0.8, "alpha_right": 0.9}
CONFIG = WindowConfig()


@pytest.fixture(scope="module")
def runs(synthetic, tmp_path_factory):
    """Three runs without noise, each of a robot with slip of its own."""
    folder = tmp_path_factory.mktemp("runs")
    made = {}
    for seed, (name, truth) in enumerate(
        {"narrow": synthetic.icrs, "wide": WIDE, "wide_too": WIDE}.items()
    ):
        odometry = synthetic.commands(np.random.default_rng(seed), 400)
        pose_s = np.arange(0, 39.5, 0.4)
        path = synthetic.write(folder / name, odometry, pose_s, synthetic.icr_twist(truth))
        made[name] = Run.read(path)
    return made


def fit_icr(windows):
    return fit(
        Icr(),
        windows,
        SimpleNamespace(track_width=0.5),
        fixed={},
        window_config=CONFIG,
        solver_config=SolverConfig(starts=1),
    )


def test_errors_are_per_metre_of_wheel_travel(runs):
    """By a prediction that is off by known numbers, and more than half a turn of yaw."""
    windows = windows_of([runs["wide"]], CONFIG)
    wrong = windows.measured + np.array([0.03, -0.04, 0.0])
    wrong[:, 2] += np.linspace(-4, 4, len(windows))
    errors = window_errors(Icr(), Icr().pack(WIDE), replace(windows, measured=wrong))
    travel = np.array(
        [
            windows.steps_s[i:j] @ np.abs(windows.inputs.tread_speeds_m_s[i:j]).mean(axis=1)
            for i, j in zip(windows.first, windows.last, strict=True)
        ]
    )
    np.testing.assert_allclose(errors.translation_per_m, 0.05 / travel, rtol=1e-9)
    turned = np.abs(np.linspace(-4, 4, len(windows)))
    np.testing.assert_allclose(errors.rotation_per_m, turned / travel, rtol=1e-9, atol=1e-12)


def test_the_runs_are_the_parts(runs):
    windows = windows_of([runs["wide"], runs["narrow"], runs["wide_too"]], CONFIG)
    parts = by_runs(windows)
    for name in runs:
        assert len(np.unique(parts[windows.run == name])) == 1
    assert len(np.unique(parts)) == 3


def test_more_runs_than_ten_are_ten_groups_of_neighbours(runs):
    """Each fold is one fit to the others: the cost grows with the windows, not with the folds."""
    windows = windows_of([runs["wide"]], replace(CONFIG, horizon_m=0.5))
    names = np.array([f"run_{i // 2:02}" for i in range(len(windows))], dtype=object)
    assert len(set(names)) > 10
    parts = by_runs(replace(windows, run=names))
    assert set(parts) == set(range(10))
    assert np.all(np.diff(parts) >= 0)
    for name in set(names):
        assert len(set(parts[names == name])) == 1
    sizes = [len(set(names[parts == part])) for part in range(10)]
    assert max(sizes) - min(sizes) <= 1


def test_runs_of_one_name_are_by_runs_their_own(runs):
    """As in two folders of recordings, of two days."""
    namesake = replace(runs["narrow"], folder=runs["narrow"].folder.parent / "day_2" / "wide")
    windows = windows_of([runs["wide"], namesake, runs["wide_too"]], CONFIG)
    assert len(np.unique(by_runs(windows))) == 3


def test_overlapping_windows_of_one_half_do_not_reach_into_the_other(runs):
    windows = windows_of([runs["narrow"]], replace(CONFIG, stride=0.25))
    parts = by_halves(windows)
    kept = [
        (windows.first_pose[parts == part].min(), windows.last_pose[parts == part].max())
        for part in (0, 1)
    ]
    assert kept[0][1] <= kept[1][0]


def test_windows_of_some_seconds_have_finite_errors_while_the_robot_stands(synthetic, tmp_path):
    odometry = synthetic.commands(np.random.default_rng(0), 300)
    odometry[100:200, 1:] = 0
    twist_of = synthetic.icr_twist(WIDE)
    run = Run.read(synthetic.write(tmp_path, odometry, np.arange(0, 29.5, 0.25), twist_of))
    windows = windows_of([run], replace(CONFIG, horizon_s=2.0))
    errors = window_errors(Icr(), Icr().pack(WIDE), windows)
    assert np.all(np.isfinite(errors.translation_per_m))


def test_the_halves_of_the_only_run_are_the_parts(runs):
    windows = windows_of([runs["narrow"]], CONFIG)
    parts = by_halves(windows)
    assert np.all(np.diff(parts[parts >= 0]) >= 0)
    assert abs(np.sum(parts == 0) - np.sum(parts == 1)) <= 2
    assert windows.start_s[parts == 0].max() < windows.start_s[parts == 1].min()


def test_each_part_is_predicted_by_the_others_alone(runs):
    """A fit never gets a window of the part on which it is evaluated."""
    windows = windows_of(list(runs.values()), CONFIG)
    windows = replace(windows, start_s=np.arange(len(windows)) * 1.0)  # a name for each
    parts = by_runs(windows)
    asked = []

    def fit_to(chosen):
        asked.append(set(chosen.start_s))
        return SimpleNamespace(model=Icr(), packed=Icr().pack(WIDE))

    held_out_errors(windows, parts, fit_to)
    everything = set(windows.start_s)
    assert asked == [everything - set(windows.start_s[parts == part]) for part in np.unique(parts)]


def test_errors_are_those_of_the_parameters_of_the_others(runs):
    """The narrow run is predicted by wide parameters, and one wide run of two by both others."""
    windows = windows_of([runs["narrow"], runs["wide"]], CONFIG)
    errors = held_out_errors(windows, by_runs(windows), fit_icr)
    for name, others in (("narrow", WIDE), ("wide", None)):
        here = windows.run == name
        values = fit_icr(windows.where(~here)).packed if others is None else Icr().pack(others)
        expected = window_errors(Icr(), values, windows.where(here))
        np.testing.assert_allclose(
            errors.translation_per_m[here], expected.translation_per_m, rtol=0, atol=1e-7
        )
        np.testing.assert_allclose(
            errors.rotation_per_m[here], expected.rotation_per_m, rtol=0, atol=1e-7
        )
        assert expected.translation_per_m.mean() > 0.01


def test_without_noise_a_model_that_fits_has_no_held_out_error(runs):
    windows = windows_of([runs["wide"], runs["wide_too"]], CONFIG)
    errors = held_out_errors(windows, by_runs(windows), fit_icr)
    np.testing.assert_allclose(errors.translation_per_m, 0, atol=1e-9)
    np.testing.assert_allclose(errors.rotation_per_m, 0, atol=1e-9)
