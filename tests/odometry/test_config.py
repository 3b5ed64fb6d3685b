from dataclasses import dataclass

import pytest

from odometry.config import block_from_table, read_toml, require
from odometry.errors import ConfigError


@dataclass(frozen=True)
class Block:
    length_m: float = 1.5
    count: int = 2
    name: str = "a"
    on: bool = False

    def __post_init__(self):
        require(self.count > 0, f"count = {self.count}, expected above 0")


def test_what_is_absent_keeps_its_default():
    assert block_from_table(Block, {}, "x.toml: [block]") == Block()


def test_values_are_taken():
    table = {"length_m": 2, "count": 3, "name": "b", "on": True}
    block = block_from_table(Block, table, "x")
    assert block == Block(2.0, 3, "b", True)
    assert isinstance(block.length_m, float)


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"lenght_m": 2}, ["lenght_m", "length_m"]),
        ({"length_m": "2"}, ["length_m", "'2'", "float"]),
        ({"length_m": True}, ["length_m", "True"]),
        ({"count": 2.0}, ["count", "2.0", "int"]),
        ({"count": True}, ["count", "True"]),
        ({"on": 1}, ["on", "1", "bool"]),
        ({"name": 1}, ["name", "1", "str"]),
        ({"count": 0}, ["count = 0"]),
    ],
)
def test_what_is_wrong_is_named(table, words):
    with pytest.raises(ConfigError) as error:
        block_from_table(Block, table, "x.toml: [block]")
    for word in ("x.toml: [block]", *words):
        assert word in str(error.value)


def test_read_toml(tmp_path):
    file = tmp_path / "a.toml"
    file.write_text("[block]\ncount = 3\n")
    assert read_toml(file) == {"block": {"count": 3}}
    for name, content in (("b.toml", b"[block"), ("c.toml", b"a = '\xff'")):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(ConfigError, match=name):
            read_toml(tmp_path / name)
    with pytest.raises(ConfigError, match="gone"):
        read_toml(tmp_path / "gone.toml")
