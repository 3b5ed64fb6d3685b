"""What was learned is proposed only where the next run can use it."""

from pathlib import Path
from types import SimpleNamespace

import pytest

from odometry.estimation.filter_event import FilterEvent
from terrain.cli.results import learned_advice

JUMP = FilterEvent("reinitialised", 1.0, 1.0, "it started anew")


def advice(*, learned=True, events=(), has_warnings=False, preset=None):
    result = SimpleNamespace(has_learned=learned, replay=SimpleNamespace(events=events))
    return learned_advice(
        result, Path("my_run"), Path("out"), has_warnings=has_warnings, preset=preset
    )


def test_what_was_learned_is_proposed():
    assert "--parameters out/learned.toml" in advice()


@pytest.mark.parametrize("doubt", [{"has_warnings": True}, {"events": (JUMP,)}])
def test_in_doubt_it_is_not_recommended(doubt):
    assert advice(**doubt).startswith("learned.toml is not recommended")
    assert advice(**doubt, learned=False) is None


def test_nothing_learned_is_not_spoken_of():
    assert advice(learned=False) is None


def test_a_preset_that_refuses_parameter_sets_is_not_offered_one():
    assert advice(preset="chen2023") is None
