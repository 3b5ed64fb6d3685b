"""gap.json has the promised form, and model.toml holds the model that was found."""

import json
from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.catalogue import added_effects
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import FromAMoment
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.effects.motion.terrain import Terrain
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.gap.answer.result import NamedEffect, Rival
from odometry.gap.prepare.statistic import Gap
from odometry.gap.show.files import write_gap
from odometry.models.icr import IcrByTerrain
from odometry.parameters import read_parameters

NUMBER = (int, float)
FORM = {
    "format": int,
    "verdict": str,
    "effects": [
        {
            "name": str,
            "form": str,
            "parameters": dict,
            "gap_before": NUMBER,
            "gap_after": NUMBER,
            "evidence": NUMBER,
        }
    ],
    "equivalent": [{"name": str, "told_apart_by": str, "by_equation": bool}],
    "where": [{"words": str, "bounds": dict, "excess": NUMBER, "share": NUMBER}],
    "gap": {"before": NUMBER, "after": NUMBER, "noise_floor": NUMBER, "unit": str},
    "holdout": {"before": NUMBER, "after": NUMBER, "noise_floor": NUMBER, "unit": str},
    "candidates": [{"name": str, "form": str, "evidence": NUMBER, "gap_after": NUMBER}],
}


def refuse(constant):
    raise AssertionError(f"{constant} is no JSON")


def content(result, folder):
    write_gap(result, folder)
    return json.loads((folder / "gap.json").read_text("utf-8"), parse_constant=refuse)


def assert_form(value, form, where):
    """What the form has is there; more may be."""
    if isinstance(form, dict):
        assert form.keys() <= value.keys(), where
        for name, part in form.items():
            assert_form(value[name], part, f"{where}.{name}")
    elif isinstance(form, list):
        assert isinstance(value, list), where
        for i, item in enumerate(value):
            assert_form(item, form[0], f"{where}[{i}]")
    else:
        assert isinstance(value, form), where


@pytest.mark.parametrize("result", ["scaled_result", "none_result", "unknown_result"])
def test_the_form(result, request, tmp_path):
    found = content(request.getfixturevalue(result), tmp_path)
    assert_form(found, FORM, "gap")
    assert list(found)[: len(FORM)] == list(FORM)
    for effect in found["effects"]:
        for parameter in effect["parameters"].values():
            assert_form(parameter, dict.fromkeys(("value", "low", "high"), NUMBER), "parameter")
            assert parameter["low"] < parameter["value"] < parameter["high"]
            assert isinstance(parameter["unit"], str)
    for region in found["where"]:
        for ends in region["bounds"].values():
            assert len(ends) == 2
            assert all(end is None or isinstance(end, NUMBER) for end in ends)


def test_the_numbers_are_those_of_the_result(scaled_result, tmp_path):
    found = content(scaled_result, tmp_path)
    assert found["verdict"] == "wheel_scale"
    assert [effect["name"] for effect in found["effects"]] == ["wheel_scale", "lever_arm"]
    assert found["effects"][0]["parameters"]["c_l"] == pytest.approx(
        {"value": 0.8, "low": 0.79, "high": 0.82, "unit": ""}
    )
    assert found["effects"][1]["parameters"]["x_arm"]["unit"] == "m"
    assert found["equivalent"][0]["name"] == "traction_loss"
    for name, closing in (("gap", scaled_result.measured), ("holdout", scaled_result.holdout)):
        assert found[name]["before"] == closing.before.value
        assert found[name]["after"] == closing.after.value
        assert found[name]["noise_floor"] == closing.noise_floor.value
        assert found[name]["unit"] == "m, RMS position error over 2 s windows"


def test_nothing_found_is_empty(none_result, tmp_path):
    found = content(none_result, tmp_path)
    assert found["verdict"] == "none"
    assert found["effects"] == []
    assert found["gap"]["before"] == found["gap"]["after"]


def test_a_remaining_part_is_an_unknown_residual_with_what_it_depends_on(unknown_result, tmp_path):
    found = content(unknown_result, tmp_path)
    effect = found["effects"][0]
    assert (found["verdict"], effect["name"], effect["form"]) == ("unknown", "unknown", "residual")
    assert effect["variable"] == "heading"


def test_what_is_not_finite_is_null(none_result, tmp_path):
    level = Gap(0.02, 0.02, 0.02, pieces=1)
    closing = replace(none_result.holdout, before=level, after=level, noise_floor=level)
    rivals = (Rival("wheel_scale", "factors", float("-inf"), float("nan")),)
    found = content(replace(none_result, holdout=closing, rivals=rivals), tmp_path)
    assert found["holdout"]["share_closed"] is None
    assert found["holdout"]["stretches"] == 1
    assert found["holdout"]["before_interval"] is None
    assert found["gap"]["before_interval"] == [
        none_result.measured.before.low,
        none_result.measured.before.high,
    ]
    assert found["candidates"][0]["evidence"] is None
    assert found["candidates"][0]["gap_after"] is None


@pytest.mark.parametrize("result", ["scaled_result", "none_result", "unknown_result"])
def test_the_model_is_read_back_as_it_was_found(result, request, tmp_path):
    result = request.getfixturevalue(result)
    write_gap(result, tmp_path)
    written = read_parameters(tmp_path / "model.toml")
    assert written.vehicle["track_width"] == result.base.robot.track_width
    ((_, table),) = written.terrains.items()
    assert table.model == "icr"
    assert list(table.values.values()) == pytest.approx(result.base.values, abs=0)
    added = added_effects(table.effects, "model.toml")
    assert [(a.effect.name, a.effect.settings()) for a in added] == [
        (a.effect.name, a.effect.settings()) for a in result.added
    ]
    for one, other in zip(added, result.added, strict=True):
        np.testing.assert_array_equal(one.values, other.values)


def test_terrains_are_tables_of_their_own(none_result, make_scene, tmp_path):
    """The shifts of a label are of all five parameters; other effects stand on each ground."""

    def terrain(t):
        return np.array(["sand", "stone", "wet grass"])[(t // 10).astype(int) % 3]

    shifts = np.array([[0.1, -0.1, 0.05, -0.1, -0.2], [0.3, -0.2, 0.0, 0.0, 0.1]])
    grounds = Added(Terrain(("sand", "wet grass")), shifts.ravel())
    offset = Added(TimeOffset(), np.array([0.1]))
    effects = tuple(
        NamedEffect(added, added.values - 1, added.values + 1, 0.2, 0.1, 50.0)
        for added in (grounds, offset)
    )
    scene = make_scene(1, duration_s=60.0, terrain=terrain)
    result = replace(
        none_result, effects=effects, measured_scenes=(scene,), holdout_scenes=(scene,)
    )
    write_gap(result, tmp_path)
    tables = read_parameters(tmp_path / "model.toml").terrains
    assert set(tables) >= {"sand", "stone", "wet grass"}
    for label, shift in (("stone", 0 * shifts[0]), ("sand", shifts[0]), ("wet grass", shifts[1])):
        assert list(tables[label].values.values()) == pytest.approx(result.base.values + shift)
        assert [effect["name"] for effect in tables[label].effects] == ["time_offset"]


def test_each_terrain_of_the_base_is_a_table_of_its_own(none_result, make_scene, tmp_path):
    """With its own ICRs, shifted where it has changed since."""
    own = {"sand": none_result.base.values, "stone": none_result.base.values + 0.1}
    model, changed = IcrByTerrain(tuple(own)), np.array([0.1, -0.1, 0.0, 0.0, 0.2])
    base = replace(none_result.base, model=model, values=np.concatenate(list(own.values())))
    known = none_result.calibration
    free = np.zeros(len(base.values), dtype=bool)
    known = replace(known, uncertain=replace(known.uncertain, base=base, free=free))
    wet = Added(Terrain(("stone",)), changed)
    effects = (NamedEffect(wet, wet.values - 1, wet.values + 1, 0.2, 0.1, 50.0),)
    scene = make_scene(1, terrain=lambda t: np.where(t < 30.0, "sand", "stone"))
    result = replace(
        none_result, base=base, calibration=known, effects=effects, holdout_scenes=(scene,)
    )
    write_gap(result, tmp_path)
    tables = read_parameters(tmp_path / "model.toml").terrains
    assert {table.model for table in tables.values()} == {"icr"}
    assert list(tables["sand"].values.values()) == pytest.approx(own["sand"])
    assert list(tables["stone"].values.values()) == pytest.approx(own["stone"] + changed)


@pytest.mark.parametrize(
    ("latency_s", "offset_s", "expected_s"),
    [(0.05, None, 0.05), (0.05, 0.1, 0.15), (1e-4, 0.1, 0.1)],
)
def test_the_latency_is_part_of_the_model(none_result, tmp_path, latency_s, offset_s, expected_s):
    effects = ()
    if offset_s is not None:
        value = np.array([offset_s])
        effects = (NamedEffect(Added(TimeOffset(), value), value, value, 0.2, 0.1, 50.0),)
    base = replace(none_result.base, latency_s=latency_s)
    write_gap(replace(none_result, base=base, effects=effects), tmp_path)
    ((_, table),) = read_parameters(tmp_path / "model.toml").terrains.items()
    (added,) = added_effects(table.effects, "model.toml")
    assert added.by_name == pytest.approx({"offset": expected_s})


def test_the_same_result_writes_the_same_bytes(scaled_result, tmp_path):
    first, again = (write_gap(scaled_result, tmp_path / name) for name in "ab")
    assert [file.name for file in first] == ["gap.json", "model.toml"]
    assert [f.read_bytes() for f in first] == [f.read_bytes() for f in again]


def test_a_moment_of_one_run_is_not_carried_to_the_next(scaled_result, tmp_path):
    """The model is that of the robot as it was at the end; gap.json says when it began."""
    lost = in_course(TractionLoss(), FromAMoment(((1.0, 150.0),)))
    values = np.array([0.8, 0.7, 67.6])
    effect = NamedEffect(Added(lost, values), values - 0.01, values + 0.01, 0.2, 0.03, 50.0)
    found = replace(scaled_result, verdict="traction_loss", effects=(effect,), equivalent=())
    (written,) = content(found, tmp_path)["effects"]
    assert written["parameters"]["moment"]["value"] == 67.6
    for terrain in read_parameters(tmp_path / "model.toml").terrains.values():
        (added,) = added_effects(terrain.effects, "model.toml")
        assert added.by_name == {"k": 0.8, "m": 0.7}
        assert not added.effect.course
