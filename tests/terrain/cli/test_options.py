import math

import click
import pytest
from click.testing import CliRunner

from odometry.models.catalogue import MODELS
from odometry.windows.config import WindowConfig
from terrain.cli.options import MODEL_NAMES, assignments, window_options


def test_the_help_names_every_model():
    """`--help` does not import them."""
    assert tuple(MODELS) == MODEL_NAMES, "MODEL_NAMES of terrain/cli/options.py has others"


def test_assignments_by_name():
    texts = ["mu=0.6", " x_icr = -1e-2 ", "h=3"]
    assert assignments(texts) == {"mu": 0.6, "x_icr": -0.01, "h": 3.0}
    assert assignments([]) == {}


@pytest.mark.parametrize("text", ["mu", "mu=", "mu=much", "mu=0.5=0.6"])
def test_what_is_no_assignment_is_shown(text):
    with pytest.raises(click.BadParameter, match="NAME=VALUE"):
        assignments([text])


@pytest.fixture
def told():
    """A command that keeps the settings it was given."""
    kept = []

    @click.command()
    @window_options
    @click.option("--other", type=int, default=1)
    def command(windows, other):
        kept.append((windows, other))

    def run(*arguments):
        answer = CliRunner().invoke(command, arguments, catch_exceptions=False)
        assert answer.exit_code == 0, answer.output
        return kept.pop()

    return run


def test_the_defaults_are_those_of_the_library(told):
    assert told() == (WindowConfig(), 1)


def test_every_option_reaches_its_setting(told):
    texts = "--horizon 3 --horizon-s 4 --stride 0.5 --position-sigma 0.1 --yaw-sigma 0.2 --other 7"
    windows, other = told(*texts.split())
    assert (windows.horizon_m, windows.horizon_s, windows.stride) == (3, 4, 0.5)
    assert (windows.position_sigma_m, windows.yaw_sigma_rad, other) == (0.1, 0.2, 7)
    assert math.isclose(windows.pose_gap_s, 0.5)
