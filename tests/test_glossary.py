"""Every parameter of a model or an effect stands in the glossary, with its unit."""

import ast
import re
from pathlib import Path

import pytest

from odometry.models.catalogue import MODELS

ROOT = Path(__file__).parents[1]
GLOSSARY = (ROOT / "data" / "README.md").read_text("utf-8").partition("### Parameters")[2]
TABLES = GLOSSARY.partition("## Settings")[0].split("Of the effects of `gap`")
OF_MODELS, OF_EFFECTS = (
    {
        (name, unit.strip())
        for names, unit in re.findall(r"^\| (`[^|]+`) \|([^|]*)\|", table, flags=re.MULTILINE)
        for name in re.findall(r"`(\w+)`", names)
    }
    for table in TABLES
)


def effect_parameters() -> set[tuple[str, str]]:
    """Names and units that are written out in the forms of effects."""
    calls = [
        node
        for file in (ROOT / "odometry" / "effects").rglob("*.py")
        for node in ast.walk(ast.parse(file.read_text("utf-8")))
        if isinstance(node, ast.Call) and ast.unparse(node.func) == "EffectParameter"
    ]
    given = [[getattr(each, "value", None) for each in call.args[:2]] for call in calls]
    return {(name, unit) for name, unit in given if isinstance(name, str) and isinstance(unit, str)}


@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
def test_parameters_of_models(model):
    assert {(each.name, each.unit) for each in model.parameters} <= OF_MODELS


def test_nothing_is_named_that_no_model_has():
    of_all = {(each.name, each.unit) for model in MODELS.values() for each in model.parameters}
    assert of_all == OF_MODELS


def test_parameters_of_effects():
    found = effect_parameters()
    assert len(found) > 40
    assert found <= OF_MODELS | OF_EFFECTS
