"""Terrain that is known by stamp: the run's own labels."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.errors import RunFolderError
from odometry.replays.terrain_sources import NamedTerrain, labelled_terrain
from tests.odometry.modes.mode_drives import run_of_tables

STAMPS_S = np.arange(6.0)


def run_with(odometry=None, truth=None):
    """A run of six seconds whose files name these terrains."""
    zeros = np.zeros(6)

    def columns(names, **others):
        labels = {} if names is None else {"terrain": np.array(names, dtype=object)}
        return {"t": STAMPS_S, **others, **labels}

    known = {} if truth is None else {"truth": columns(truth, x=zeros, y=zeros, yaw=zeros)}
    return run_of_tables(columns(odometry, v_left=zeros, v_right=zeros), **known)


def at(source, *stamps_s):
    return [source.terrain(SimpleNamespace(stamp_s=stamp_s), None) for stamp_s in stamps_s]


def test_a_label_holds_from_its_row_on():
    source = labelled_terrain(run_with(odometry=["ice", "ice", "mud", "mud", "ice", ""]))
    assert source.initial == "ice"
    assert at(source, 0.0, 1.99, 2.0, 3.5, 4.0, 5.0, 99.0) == [
        *("ice", "ice", "mud", "mud"),
        *("ice", "ice", "ice"),
    ]


def test_no_label_and_unknown_keep_the_terrain_in_force():
    source = labelled_terrain(run_with(odometry=["", "ice", "unknown", "", "mud", ""]))
    assert source.initial == "ice"
    assert at(source, 0.5, 1.0, 2.0, 3.0, 4.0, 5.5) == ["ice", "ice", "ice", "ice", "mud", "mud"]


def test_before_the_first_label_the_terrain_that_was_named_is_in_force():
    run = run_with(odometry=["", "", "ice", "ice", "ice", "ice"])
    assert at(labelled_terrain(run, "mud"), 0.0, 1.9, 2.0) == ["mud", "mud", "ice"]


def test_the_truth_knows_better_than_the_recording():
    truth, recorded = ["ice"] * 3 + ["mud"] * 3, ["ice"] * 5 + ["mud"]
    both = run_with(odometry=recorded, truth=truth)
    assert at(labelled_terrain(both), 3.0) == ["mud"]
    nameless = run_with(odometry=recorded, truth=["unknown"] * 6)
    assert at(labelled_terrain(nameless), 3.0) == ["ice"]


@pytest.mark.parametrize("names", [None, [""] * 6, ["unknown"] * 6])
def test_a_run_that_names_no_terrain_is_an_error(names):
    with pytest.raises(RunFolderError, match="names a terrain"):
        labelled_terrain(run_with(odometry=names))


@given(
    answers=st.lists(st.sampled_from(["ice", "mud", "undetermined"]), min_size=1, max_size=12),
    ask_s=st.floats(-1.0, 13.0),
)
def test_a_source_says_what_one_would_by_walking_along_the_answers(answers, ask_s):
    stamps_s = np.arange(float(len(answers)))
    named = np.array(answers, dtype=object)
    source = NamedTerrain.of_answers("sand", stamps_s, named, ("undetermined",))
    held = "sand"
    for stamp_s, answer in zip(stamps_s, answers, strict=True):
        if stamp_s <= ask_s and answer != "undetermined":
            held = answer
    assert at(source, ask_s) == [held]
