"""Stretches in which the terrain in force is `unknown`: printed, on the page and in result.json."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from terrain.cli.results import print_changes
from terrain.config import Config
from terrain.main_job import run_odometry
from terrain.report.tables import switch_table
from terrain.result.result_table import result_table
from terrain.result.run_result import RunResult
from terrain.switch.switch import SwitchConfig, SwitchEvent

LABEL = SimpleNamespace(stamp_s=4.0, distance_ahead_m=1.0)


def changes(terrains, events):
    """Changes of a run with a camera, one frame a second."""
    of = SimpleNamespace(
        watcher=SimpleNamespace(events=events),
        changes=tuple(events),
        initial_terrain="ice",
        in_force=None,
        replay=SimpleNamespace(stamps_s=np.arange(float(len(terrains))), terrains=terrains),
    )
    of.in_force = RunResult.in_force.fget(of)
    found = RunResult.changes_and_unknown.fget(of)
    return [(change.terrain, change.stamp_s) for change in found]


def test_unknown_stretches_stand_between_the_changes():
    soil = SwitchEvent("soil", 5.0, LABEL, 1.0, 1.0)
    assert changes(["ice"] * 3 + ["unknown"] * 2 + ["soil"] * 3, [soil]) == [
        ("unknown", 3.0),
        ("soil", 5.0),
    ]


def test_the_same_terrain_after_an_unknown_stretch_is_named_again():
    assert changes(["ice", "unknown", "unknown", "ice", "unknown"], []) == [
        ("unknown", 1.0),
        ("ice", 3.0),
        ("unknown", 4.0),
    ]
    assert changes(["ice"] * 4, []) == []


@pytest.fixture(scope="module")
def unsupported(across_run, classifier):
    """A run whose labels stop to support the terrain after 2 cm, so that it is unknown often."""
    config = Config(switch=SwitchConfig(unknown_m=0.02))
    return run_odometry(across_run, model=classifier, terrain="gravel", config=config)


def test_a_run_says_where_it_is_unknown(unsupported, capsys):
    unknown = [of for of in unsupported.in_force if of.terrain == "unknown"]
    assert unknown
    print_changes(unsupported)
    assert "s unknown" in capsys.readouterr().out
    rows = switch_table(unsupported).rows
    assert sum(row[0] == "unknown" for row in rows) == len(unknown)
    assert {len(row) for row in rows} == {len(switch_table(unsupported).header)}
    table = json.loads(json.dumps(result_table(unsupported)))
    assert [of["from_s"] for of in table["unknown_in_force"]] == [of.start_s for of in unknown]


def test_a_run_without_one_has_the_changes_alone(across_result):
    assert not any(of.terrain == "unknown" for of in across_result.in_force)
    assert across_result.changes_and_unknown == across_result.changes
    assert result_table(across_result)["unknown_in_force"] == []
