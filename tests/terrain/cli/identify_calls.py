"""Calls of `identify` as a user makes them, and what a refusal is."""

import sys

import pytest

from terrain.cli.main import main

SHORT = ("--horizon", "0.5", "--starts", "1")


@pytest.fixture
def command(monkeypatch, capsys, tmp_path):
    """Run the verb as a user would: its exit code, output and messages; the file to write."""
    out = tmp_path / "set.toml"

    def run(*arguments, model="icr"):
        texts = ["identify", "--model", model, "--out", str(out), *map(str, arguments)]
        monkeypatch.setattr(sys, "argv", ["terrain-odometry", *texts])
        with pytest.raises(SystemExit) as caught:
            main()
        output, messages = capsys.readouterr()
        return caught.value.code, output, messages

    run.out = out
    return run


def assert_refused(command, answer, *words, code=1):
    assert answer[0] == code, answer
    assert "Traceback" not in answer[2]
    for word in words:
        assert word in answer[2]
    assert not command.out.exists()
