"""Numbers that mean nothing, in every option that takes one: one line, and nothing is written."""

import click
import pytest
from click.testing import CliRunner

from odometry.errors import OdometryError
from terrain.cli.main import cli

ODD = ("nan", "inf", "-inf", "1e300", "-1e300", "1e-300", "0", "-1")
WINDOWS = ("--horizon", "--stride", "--position-sigma", "--yaw-sigma")
IDENTIFY = ("identify", "absent", "--model", "icr", "--out", "set.toml")
COMPARE = ("compare", "absent", "--out", "out")
SIMULATE = ("simulate", "--out", "out")
SYNTHESISE = ("synthesise", "--out", "out")
OPTIONS = [
    *((IDENTIFY, option) for option in WINDOWS),
    *((COMPARE, option) for option in (*WINDOWS, "--evaluation-horizon")),
    (("gap", "absent", "--calibration", "other", "--out", "out"), "--horizon-s"),
    *((SIMULATE, option) for option in ("--duration", "--max-speed", "--friction")),
    *((SYNTHESISE, o) for o in ("--zone-length", "--metres-per-pixel", "--image-rate")),
    (("train", "absent", "--out", "a.model"), "--metres-per-pixel"),
    (("identify-modes", "absent", "--out", "set.toml"), "--dwell"),
    (("identify-feel", "absent", "--out", "my.feel"), "--window"),
]
EITHER_SIGN = [
    (IDENTIFY, "--horizon-s", "1e-300"),
    (IDENTIFY, "--horizon", "1e-9"),
    *((SIMULATE, "--slope", odd) for odd in ("nan", "inf", "1e300", "90")),
    *((SIMULATE, "--slope-direction", odd) for odd in ("nan", "-inf", "1e300")),
    *((SIMULATE, "--traction", odd) for odd in ("asphalt@nan", "asphalt@inf", "asphalt@-1")),
]


@pytest.fixture(autouse=True)
def in_an_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    yield
    assert not list(tmp_path.iterdir())


def assert_one_line(*arguments):
    """The exit code 1 or 2 of the command line, by a known error or by click's."""
    answer = CliRunner().invoke(cli, arguments)
    if isinstance(answer.exception, SystemExit):
        assert answer.exit_code == 2
    else:
        assert isinstance(answer.exception, OdometryError), answer.exception
        assert len(str(answer.exception).splitlines()) == 1
        assert "absent" not in str(answer.exception)  # the message is about the number


@pytest.mark.parametrize("odd", ODD)
@pytest.mark.parametrize(("verb", "option"), OPTIONS)
def test_what_must_be_above_zero(verb, option, odd):
    assert_one_line(*verb, option, odd)


@pytest.mark.parametrize(("verb", "option", "odd"), EITHER_SIGN)
def test_what_may_have_either_sign(verb, option, odd):
    assert_one_line(*verb, option, odd)


def test_click_alone_lets_nan_pass():
    """Why there is a type of our own; without it this assumption would go unnoticed."""
    assert click.FloatRange(min=0).convert("nan", None, None) != 0
