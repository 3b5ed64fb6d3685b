"""Settings from TOML: what is read, what is refused, and what is written beside results."""

import json

import pytest

from odometry.errors import ConfigError
from terrain.config import Config

FULL = """
[filter]
gate_probability = 0.99
detect_jumps = true
[region]
ahead_s = 2
per_tread = true
[switch]
labels_in_row = 3
on_arrival = false
[evaluation]
horizon_m = 2.5
"""


@pytest.fixture
def read(tmp_path):
    def read_text(text):
        (tmp_path / "config.toml").write_text(text)
        return Config.read(tmp_path / "config.toml")

    return read_text


def test_an_empty_file_is_the_default(read):
    assert read("") == Config()


def test_the_footprint_is_enlarged_as_in_the_paper():
    """Chen 2023, 3.2.2: 1.2 times the footprint."""
    assert Config().region.footprint_scale == 1.2


def test_every_block_is_read_and_the_rest_stays(read):
    config = read(FULL)
    assert config.filter.gate_probability == 0.99
    assert config.filter.detect_jumps is True
    assert config.filter.gate_patience == Config().filter.gate_patience
    assert config.region.ahead_s == 2.0
    assert config.region.per_tread is True
    assert (config.switch.labels_in_row, config.switch.on_arrival) == (3, False)
    assert config.evaluation.horizon_m == 2.5


def test_the_table_is_plain_and_holds_every_setting(read):
    table = read(FULL).to_table()
    assert json.loads(json.dumps(table, allow_nan=False)) == table
    assert table["region"]["ahead_s"] == 2.0
    assert (table["switch"]["labels_in_row"], table["switch"]["on_arrival"]) == (3, False)
    assert set(table) == {"filter", "region", "switch", "classifier", "evaluation"}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[camera]\n", "unknown block 'camera'"),
        ("region = 3\n", "unknown block 'region'"),
        ("[region]\nahead = 2\n", r"\[region\]: unknown key 'ahead'.*ahead_s"),
        ("[region]\nahead_s = 'far'\n", r"\[region\]: ahead_s = 'far'"),
        ("[region]\nahead_s = true\n", r"\[region\]: ahead_s = True"),
        ("[switch]\nlabels_in_row = -1\n", r"\[switch\]: labels_in_row = -1"),
        ("[switch]\nlabel_accuracy = 1.0\n", r"\[switch\]: label_accuracy = 1.0"),
        ("[switch]\nchange_m = 0.0\n", r"\[switch\]: change_m = 0.0"),
        ("[switch]\nlabels_in_row = 2.5\n", r"\[switch\]: labels_in_row = 2.5"),
        ("[filter\n", "cannot be read as TOML"),
    ],
)
def test_what_is_wrong_is_named_with_file_and_block(read, text, message):
    with pytest.raises(ConfigError, match=rf"config\.toml: .*{message}|config\.toml: {message}"):
        read(text)


def test_a_missing_file_is_a_clear_error(tmp_path):
    with pytest.raises(ConfigError, match=r"absent\.toml"):
        Config.read(tmp_path / "absent.toml")
