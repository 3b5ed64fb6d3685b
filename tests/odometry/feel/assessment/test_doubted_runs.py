"""Runs that feel like another terrain than the one they name are noted."""

from dataclasses import replace

import numpy as np

from odometry.feel.assessment.assessment import Answers, Assessment
from odometry.feel.assessment.doubted_runs import MOST_NOTES, notes_of_doubted
from odometry.feel.identify_feel import identify_feel
from tests.odometry.feel.feel_drives import drive


def assessment(*rows):
    """Of runs on tiles or gravel, by how probable tiles are."""
    labels = np.array([name for name, _ in rows], dtype=object)
    tiles = np.array([probability for _, probability in rows])
    answers = Answers(
        labels, np.arange(len(rows)), np.column_stack([1 - tiles, tiles]), tiles > 1.0
    )
    return Assessment(("gravel", "tiles"), {"run": answers}, (), {})


def notes(*rows):
    return list(notes_of_doubted(assessment(*rows), [f"run_{i}" for i in range(len(rows))]))


def test_a_run_that_feels_like_another_terrain_is_noted():
    (note,) = notes(("tiles", 0.95), ("tiles", 0.04), ("gravel", 0.3))
    assert note.startswith("run_1, named tiles, feels like gravel (0.96, tiles 0.04)")


def test_a_run_that_is_as_probable_as_not_is_no_doubt():
    assert notes(("tiles", 0.4), ("tiles", 0.12), ("gravel", 0.88)) == []


def test_the_most_certain_come_first_and_few_are_written():
    found = notes(*[("gravel", 0.91 + 0.01 * i) for i in range(MOST_NOTES + 2)])
    assert found[0].startswith(f"run_{MOST_NOTES + 1}, named gravel, feels like tiles (0.95")
    assert len(found) == MOST_NOTES + 1
    assert found[-1].endswith(": 2.")


def test_a_wrong_name_is_noted_where_feel_is_identified():
    runs = [drive(name, 10 * i + j, seconds=12.0) for i, name in enumerate(("tiles", "gravel"))
            for j in range(4)]  # fmt: skip
    runs[0] = replace(runs[0], settings={**runs[0].settings, "run": {"terrain": "gravel"}})
    noted = [note for note in identify_feel(runs).report["notes"] if "feels like" in note]
    assert any(note.startswith("tiles_0, named gravel, feels like tiles") for note in noted)
