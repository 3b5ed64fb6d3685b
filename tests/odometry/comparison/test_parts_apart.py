"""Runs, or halves of one run, of two terrains under one name: no order of models is of either."""

import shutil

import numpy as np
import pytest

from odometry.comparison.compare import compare
from odometry.recording.run import Run

ICE = {"y_left": 0.75, "y_right": -0.7, "x_icr": 0.05, "alpha_left": 0.8, "alpha_right": 0.85}


def first_sentences(runs, quick):
    compared = compare(runs, config=quick)
    return [compared.sentences_at(place)[0] for place in compared.places]


@pytest.fixture(scope="module")
def driven(bench, tmp_path_factory):
    """Runs of 60 s by name: two on one terrain, and one on another of the same name."""
    folder = tmp_path_factory.mktemp("apart")
    made = {}
    for i, (name, icrs) in enumerate(
        {"one": bench.skewed, "two": bench.skewed, "ice": ICE}.items()
    ):
        speeds = bench.varied(np.random.default_rng(20 + i), 60)
        made[name] = Run.read(bench.write(folder / name, speeds, seed=i, icrs=icrs))
    return made


def test_a_run_of_another_terrain_is_named_before_any_order(driven, quick):
    (said,) = first_sentences(list(driven.values()), quick)
    assert said.startswith("The runs do not fit one model: ")
    named = said.split(":")[1].split(".")[0]
    assert {frozenset(part.strip().split(", ")) for part in named.split(" against ")} == {
        frozenset(("one", "two")),
        frozenset(("ice",)),
    }


def test_runs_of_one_terrain_are_ranked_at_once(driven, quick):
    (said,) = first_sentences([driven["one"], driven["two"]], quick)
    assert "has the smallest error" in said


def test_runs_that_are_held_out_may_differ_from_those_of_train(driven, quick):
    compared = compare([driven["ice"]], train=[driven["one"], driven["two"]], config=quick)
    assert "do not fit one model" in compared.sentences_at(compared.places[0])[0]


def test_halves_of_one_run_that_differ_are_named(driven, quick, tmp_path):
    """From its middle on the treads turn by 1.3 times as much: another slip."""
    changed = tmp_path / "changed"
    shutil.copytree(driven["one"].folder, changed)
    rows = np.genfromtxt(changed / "odometry.csv", delimiter=",", names=True)
    for name in ("v_left", "v_right"):
        rows[name][len(rows) // 2 :] *= 1.3
    header = ",".join(rows.dtype.names)
    np.savetxt(changed / "odometry.csv", rows, delimiter=",", header=header, comments="")
    (said,) = first_sentences([Run.read(changed)], quick)
    assert said.startswith("The first and the second half of the runs give different parameters")
