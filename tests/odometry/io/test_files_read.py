"""Lines without end, TOML and JSON beyond all measure, and paths that lead out."""

import stat
from pathlib import Path

import pytest

from odometry.errors import ConfigError, RunFolderError
from odometry.io import files
from odometry.io.files import leads_out, opened_lines, read_bytes
from odometry.io.structured import DEPTH, JSON_BYTES, TOML_BYTES, read_json, read_toml


def test_a_name_with_a_nul_is_reported():
    with pytest.raises(ConfigError, match="null"):
        read_bytes(Path("a\0b"), ConfigError, 10, "")


def test_a_file_that_may_not_be_read_is_reported(tmp_path, monkeypatch):
    file = tmp_path / "a.toml"
    file.touch()

    def refuse(self, mode):
        raise PermissionError(13, "Permission denied", str(self), mode)

    monkeypatch.setattr(Path, "open", refuse)
    with pytest.raises(ConfigError, match=r"a\.toml: cannot be read: Permission denied"):
        read_bytes(file, ConfigError, 10, "")


def test_sockets_have_a_word_too():
    assert files._kind(stat.S_IFSOCK) == "a socket or the like"
    assert files._kind(stat.S_IFBLK) == "a device"


def test_lines_have_an_end(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("t,x\n" + "1," * 70_000)
    with (
        pytest.raises(ConfigError, match="row 2 has 65536 characters or more"),
        opened_lines(file, ConfigError) as lines,
    ):
        list(lines)


DEEP = {
    "tables in a header": "[" + ".".join(["a"] * 3000) + "]\n",
    "tables in a key": ".".join(["a"] * 3000) + " = 1\n",
    "tables with quotes": "[" + ".".join(['"a"'] * 3000) + "]\n",
    "inline tables": "a = " + "{a = " * 3000 + "1" + "}" * 3000 + "\n",
    "lists": "a = " + "[" * 3000 + "]" * 3000 + "\n",
    "a few levels too many": "a = " + "[" * DEPTH + "]" * DEPTH + "\n",
}


@pytest.mark.parametrize("content", DEEP.values(), ids=DEEP)
def test_deep_toml_is_refused(tmp_path, content):
    file = tmp_path / "run.toml"
    file.write_text(content)
    with pytest.raises(RunFolderError, match=r"run\.toml: (nested too deeply|a key of more than)"):
        read_toml(file, RunFolderError)


def test_as_deep_as_may_be_is_read(tmp_path):
    file = tmp_path / "a.toml"
    file.write_text("a = " + "[" * (DEPTH - 1) + "]" * (DEPTH - 1) + "\n")
    assert set(read_toml(file, ConfigError)) == {"a"}


@pytest.mark.parametrize("digits", ["1" * 6000, "0x" + "f" * 6000, str(2**63), str(-(2**63) - 1)])
def test_integers_of_more_than_64_bits_are_refused(tmp_path, digits):
    file = tmp_path / "a.toml"
    file.write_text(f"a = [{{ b = {digits} }}]\n")
    with pytest.raises(ConfigError, match=r"a\.toml: .*(64 bits|digits)"):
        read_toml(file, ConfigError)
    file.write_text(f"a = {2**63 - 1}\nb = {-(2**63)}\n")
    assert read_toml(file, ConfigError) == {"a": 2**63 - 1, "b": -(2**63)}


def test_large_files_are_refused_by_their_size(tmp_path):
    file = tmp_path / "a.toml"
    file.write_bytes(b"#" * (TOML_BYTES + 1))
    with pytest.raises(ConfigError, match=f"{TOML_BYTES + 1} bytes, expected at most {TOML_BYTES}"):
        read_toml(file, ConfigError)
    file.write_bytes(b" " * (JSON_BYTES + 1))
    with pytest.raises(ConfigError, match="expected at most"):
        read_json(file, ConfigError)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("[" * 100_000, "nested too deeply"),
        ("[" * 40 + "]" * 40, "nested too deeply"),
        ('{"a": NaN}', "it holds NaN"),
        ("[-Infinity]", "it holds -Infinity"),
        ("[" + "1" * 6000 + "]", "digits"),
        (f"[{2**63}]", "64 bits"),
        ('{"\\ud800": 1}', "half of a character"),
        ("{", "cannot be read as JSON"),
        (b"\xff\xfe\xfd", "cannot be read as JSON"),
    ],
)
def test_json_beyond_measure_is_refused(tmp_path, content, words):
    file = tmp_path / "a.json"
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(ConfigError, match=words) as error:
        read_json(file, ConfigError)
    assert len(str(error.value).splitlines()) == 1


def test_paths_that_lead_out(tmp_path):
    folder, outside = tmp_path / "run", tmp_path / "outside"
    (folder / "images").mkdir(parents=True)
    outside.mkdir()
    for file in (folder / "images" / "a.png", outside / "a.png"):
        file.touch()
    (folder / "link.png").symlink_to(outside / "a.png")
    (folder / "linked").symlink_to(outside)
    (folder / "inner.png").symlink_to(folder / "images" / "a.png")
    (folder / "loop").symlink_to(folder / "loop")
    for name in ("../outside/a.png", "images/../../run2/a.png", "link.png", "linked/a.png", "/etc"):
        assert leads_out(folder, name), name
    for name in ("images/a.png", "images/../images/a.png", "inner.png", "absent.png", "loop"):
        assert not leads_out(folder, name), name
    (tmp_path / "way").symlink_to(folder)
    assert not leads_out(tmp_path / "way", "images/a.png")
    assert leads_out(tmp_path / "way", "../outside/a.png")


def test_a_mark_of_the_byte_order_is_no_toml_but_is_read(tmp_path):
    file = tmp_path / "run.toml"
    file.write_bytes("a = 1\n".encode("utf-8-sig"))
    assert read_toml(file, RunFolderError) == {"a": 1}
