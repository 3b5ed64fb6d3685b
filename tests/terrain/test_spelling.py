"""Names that are spellings of one terrain, wherever names are compared."""

import pytest
from click.testing import CliRunner

from odometry.parameters import ParameterSet
from terrain.cli.verbs.label import label
from terrain.errors import PatchError
from terrain.spelling import alike_names, plain_name
from terrain.terrain_names import name_notes


@pytest.mark.parametrize("other", ["WET GRASS", "wet-grass", "wetgrass", "Wet.Grass", "wet grass "])
def test_capitals_spaces_and_marks_between_words_make_no_other_name(other):
    assert alike_names(["mud", "wet_grass", other]) == ["wet_grass", other]


def test_other_signs_numbers_and_words_do():
    assert not alike_names(["soil_1", "soil_2", "gravel+", "gravel", "-", "--", "Gras", "gravel>"])
    assert plain_name("\u1e9eoil") == plain_name("SSOIL")


@pytest.mark.parametrize("other", ["Wet grass", "wet-grass"])
def test_label_and_the_notes_of_run_have_one_rule(other, across_run, tmp_path):
    known = ParameterSet({"wet_grass": None})
    assert name_notes(other, None, known)[0].endswith("here: give both one name")
    spans = ["--span", "0:1=wet_grass", "--span", f"1:9={other}"]
    answer = CliRunner().invoke(label, [str(across_run), *spans, "--out", str(tmp_path / "out")])
    assert isinstance(answer.exception, PatchError)
    assert "differ by capitals, spaces, hyphens, underscores or dots" in str(answer.exception)
