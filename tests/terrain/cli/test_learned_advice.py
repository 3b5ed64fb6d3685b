"""What was learned is proposed only where the next run can use it."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.estimation.filter_event import FilterEvent
from terrain.cli.results import learned_advice

JUMP = FilterEvent("reinitialised", 1.0, 1.0, "it started anew")


def advice(*, learned=True, known=True, poses=1, before=(), **rest):
    replay = SimpleNamespace(events=rest.pop("events", ()), accepted=np.arange(3) < poses)
    tables = {"grass": object(), "mud": object()} if known else {}
    result = SimpleNamespace(
        has_learned=learned,
        learned=SimpleNamespace(terrains=tables),
        parameters=SimpleNamespace(terrains={name: tables[name] for name in before}),
        replay=replay,
    )
    rest = {"has_warnings": False, "preset": None} | rest
    return learned_advice(result, Path("my_run"), Path("out"), **rest)


def test_what_was_learned_is_proposed():
    assert advice().endswith("--parameters out/learned.toml starts from what was learned")
    assert advice(before=["mud"]).endswith("what was learned (mud as given)")


@pytest.mark.parametrize("doubt", [{"has_warnings": True}, {"events": (JUMP,)}])
def test_in_doubt_it_is_not_recommended(doubt):
    assert advice(**doubt).startswith("learned.toml is not recommended")
    assert advice(**doubt, learned=False, known=False) is None


@pytest.mark.parametrize(("poses", "why"), [(0, "no pose was used"), (1, "smaller uncertainties")])
def test_a_set_that_nothing_changed_is_said_to_be_the_one_given(poses, why):
    said = advice(learned=False, poses=poses)
    assert said.startswith("learned.toml holds the tables of --parameters: nothing was learned")
    assert why in said


def test_without_learned_toml_nothing_is_said():
    assert advice(learned=False, known=False) is None


def test_a_preset_that_refuses_parameter_sets_is_not_offered_one():
    assert advice(preset="chen2023") is None
