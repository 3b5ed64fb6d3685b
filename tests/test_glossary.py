"""Every model and effect has its row in the guide, every parameter its unit in the glossary."""

import ast
import re
from pathlib import Path

import pytest

from odometry.effects.catalogue import BY_FORM
from odometry.models.catalogue import MODELS

ROOT = Path(__file__).parents[1]
GLOSSARY = (ROOT / "data" / "README.md").read_text("utf-8").partition("### Parameters")[2]
TABLES = GLOSSARY.partition("## Settings")[0].split("Of the effects of `gap`")
GUIDE = (ROOT / "odometry" / "README.md").read_text("utf-8")
TABLE_OF_MODELS, TABLES_OF_EFFECTS = (
    re.findall(r"^\| `.*$", GUIDE.partition(begin)[2].partition(end)[0], flags=re.MULTILINE)
    for begin, end in (
        ("\n## Kinematic models\n", "\n## "),
        ("\n### The catalogue\n", "\n## "),
    )
)
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


def assert_all_stand_in(found, known):
    missing = [f"`{name}` ({unit or 'no unit'})" for name, unit in sorted(found - known)]
    assert not missing, f"no row of data/README.md, Parameters, has {', '.join(missing)}"


@pytest.mark.parametrize("model", MODELS)
def test_models_of_the_guide(model):
    rows = [row for row in TABLE_OF_MODELS if row.startswith(f"| `{model}` |")]
    assert len(rows) == 1, f"odometry/README.md, Kinematic models, has no row of `{model}`"


@pytest.mark.parametrize(("name", "form"), BY_FORM)
def test_effects_of_the_guide(name, form):
    """Those of the reference have a table of their own, whose rows begin with the form."""
    rows = [
        row
        for row in TABLES_OF_EFFECTS
        if f"`{form}`" in row and (name == "reference_fault" or row.startswith(f"| `{name}`"))
    ]
    assert rows, f"odometry/README.md, The catalogue, has no row of `{name}`: `{form}`"


@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
def test_parameters_of_models(model):
    assert_all_stand_in({(each.name, each.unit) for each in model.parameters}, OF_MODELS)


def test_nothing_is_named_that_no_model_has():
    of_all = {(each.name, each.unit) for model in MODELS.values() for each in model.parameters}
    assert of_all == OF_MODELS


def test_parameters_of_effects():
    found = effect_parameters()
    assert len(found) > 40
    assert_all_stand_in(found, OF_MODELS | OF_EFFECTS)
