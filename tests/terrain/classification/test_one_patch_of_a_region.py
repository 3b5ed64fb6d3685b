"""`fast` looks at the middle patch of the region in a run; models of before at all of it."""

import numpy as np
import pytest

from terrain.classification.classifier import TerrainClassifier
from terrain.classification.model_file import read_model, write_model
from terrain.errors import ModelFileError


@pytest.fixture(scope="module", params=["fast", "default"])
def trained(request):
    rng = np.random.default_rng(1)
    mud = [rng.integers(0, 60, (32, 32), dtype=np.uint8) for _ in range(8)]
    snow = [cut + np.uint8(190) for cut in mud]
    return TerrainClassifier(request.param).fit(mud + snow, ["mud"] * 8 + ["snow"] * 8)


def seen(model):
    return [model.middle_used(shape) for shape in ((100, 70), (32, 95), (20, 40))]


ONE, WHOLE = [(32, 32), (32, 32), (20, 32)], [(96, 64), (32, 64), (0, 32)]


def test_what_is_looked_at_comes_back_from_a_file(trained, tmp_path):
    expected = ONE if trained.preset == "fast" else WHOLE
    assert seen(trained) == expected
    trained.save(tmp_path / "a.model")
    assert seen(TerrainClassifier.load(tmp_path / "a.model")) == expected


def test_a_file_that_does_not_say_so_looks_at_everything(trained, tmp_path):
    trained.save(tmp_path / "a.model")
    settings, arrays = read_model(tmp_path / "a.model")
    del settings["one_patch"]
    write_model(tmp_path / "b.model", settings, arrays)
    assert seen(TerrainClassifier.load(tmp_path / "b.model")) == WHOLE


def test_a_file_that_says_something_else_is_refused(trained, tmp_path):
    trained.save(tmp_path / "a.model")
    settings, arrays = read_model(tmp_path / "a.model")
    write_model(tmp_path / "b.model", settings | {"one_patch": "yes"}, arrays)
    with pytest.raises(ModelFileError, match="one_patch"):
        TerrainClassifier.load(tmp_path / "b.model")
