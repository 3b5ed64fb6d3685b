"""A verb as a user calls it."""

import sys
from types import SimpleNamespace

import pytest

from terrain.cli.main import main


@pytest.fixture
def verb(monkeypatch, capsys):
    """Run a verb: its exit code, and all that it says."""

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["terrain-odometry", *map(str, arguments)])
        with pytest.raises(SystemExit) as caught:
            main()
        return SimpleNamespace(exit_code=caught.value.code, output="".join(capsys.readouterr()))

    return call
