"""Held-out windows on real recordings against those that the recordings' makers evaluated.

INDEX.csv has the mean errors per metre over 2 m of the ideal differential drive and of a symmetric
ICR fit whose values it states. Its windows straddle joints of the chained poses, as ours do, and
gaps, as ours do not: single runs differ, the recordings as a whole do not.
"""

import csv

import numpy as np

from odometry.comparison.evaluation import evaluation_windows
from odometry.comparison.split import parts_by_terrain
from odometry.models.catalogue import MODELS
from odometry.recording.run import Run
from odometry.recording.run_terrains import with_named_terrain
from odometry.windows.config import WindowConfig
from odometry.windows.window_errors import window_errors


def mean_errors(windows, model, **values):
    model = MODELS[model]
    errors = window_errors(model, model.pack(values), windows)
    return [errors.translation_per_m.mean(), np.degrees(errors.rotation_per_m.mean())]


def test_errors_over_two_metres_meet_the_index(shared_data):
    ratios, counts = [], []
    with (shared_data / "motion" / "INDEX.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            run = with_named_terrain(Run.read(shared_data / "motion" / row["run"]), None)
            if run.pose is None:
                continue
            (part,) = parts_by_terrain(run, run.name).values()
            windows = evaluation_windows(part, 2.0, WindowConfig())
            ideal = mean_errors(windows, "differential_drive", track_width=run.robot.track_width)
            fitted = mean_errors(
                windows, "icr_symmetric", alpha=float(row["alpha"]), b_hat=float(row["b_hat"])
            )
            names = ("ideal_te_per_m", "ideal_he_deg_per_m", "icr_te_per_m", "icr_he_deg_per_m")
            ratios.append(np.array([*ideal, *fitted]) / [float(row[name]) for name in names])
            counts.append(len(windows) / float(row["n_win"]))
    assert len(ratios) == 26
    np.testing.assert_allclose(np.median(ratios, axis=0), 1, atol=0.03)
    np.testing.assert_allclose(ratios, 1, atol=0.4)
    assert min(counts) > 0.7
    assert max(counts) <= 1.1
