"""A run with vision, the same one without, and the fullest report of it."""

import dataclasses

import numpy as np
import pytest

from odometry.evaluation.score import reference_of
from odometry.tables.table import Table
from terrain.main_job import run_odometry
from terrain.report import page
from terrain.report.page import write_report
from tests.terrain.report.page_reader import SHORT


def with_truth(result, world):
    """The same result with a truth: what the tests laid out, aside by 0.1 m and 2 % askew."""
    t = result.run.odometry.stamps_s
    x = world.speed_m_s * t
    on_boards = (x >= world.edges_m[0]) & (x < world.edges_m[1])
    columns = {"t": t, "x": x, "y": 0.1 + 0.02 * x, "yaw": 0 * t}
    columns["terrain"] = np.where(on_boards, "boards", "gravel").astype(object)
    columns |= {"y_left": 0 * t + 0.2, "y_right": 0 * t - 0.2, "x_icr": 0 * t}
    truth = Table(result.run.folder / "truth.csv", columns, np.arange(len(t)) + 2)
    run = dataclasses.replace(result.run, truth=truth)
    name, reference = reference_of(run)
    return dataclasses.replace(
        result, run=run, config=SHORT, reference_name=name, reference=reference
    )


@pytest.fixture(scope="module")
def seen(across_result, world):
    """With vision and truth."""
    return with_truth(across_result, world)


@pytest.fixture(scope="module")
def blind(across_run, world):
    """The same run with one terrain throughout."""
    return with_truth(run_odometry(across_run, vision=False, terrain="gravel"), world)


@pytest.fixture(scope="module")
def full(seen, blind, tmp_path_factory):
    """Folder of the fullest report, and what was said to be in it."""
    out = tmp_path_factory.mktemp("full")
    return out, write_report(seen, out, {"without <vision>": blind})


@pytest.fixture
def no_photographs(monkeypatch):
    """For tests of what the page says: its slowest two pictures are left out."""
    for name in ("regions_picture", "whole_image_picture"):
        monkeypatch.setattr(page, name, lambda *_: None)
