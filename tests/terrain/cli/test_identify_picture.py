"""`identify --picture`: drawn beside the parameter set, which stands without it."""

import signal

import pytest

from odometry.errors import OdometryError
from odometry.positions import heading
from terrain.cli.main import Interrupted
from tests.terrain.cli.identify_calls import SHORT


def test_a_picture_is_drawn_where_asked_and_part_of_no_identity(command, curvy_run, tmp_path):
    picture = tmp_path / "icrs.png"
    assert command(curvy_run, *SHORT)[0] == 0
    without = command.out.read_bytes()
    for _ in range(2):
        code, output, _ = command(curvy_run, *SHORT, "--picture", picture)
        assert code == 0
        assert f"Wrote {picture}" in output
    assert command.out.read_bytes() == without
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(("name", "code"), [("photo.png", 1), ("photo.jpg", 2)])
def test_a_picture_that_cannot_be_written_is_refused_first(
    command, curvy_run, tmp_path, name, code
):
    (tmp_path / name).write_bytes(b"a photograph")
    found, _, messages = command(curvy_run, *SHORT, "--picture", tmp_path / name)
    assert found == code
    assert name in messages
    assert not command.out.exists()
    assert (tmp_path / name).read_bytes() == b"a photograph"


def test_a_picture_that_cannot_be_drawn_costs_no_parameters(
    command, curvy_run, tmp_path, monkeypatch
):
    """As where positions do not determine the yaw: a picture of an earlier call must not stay."""
    picture = tmp_path / "icrs.png"
    assert command(curvy_run, *SHORT, "--picture", picture)[0] == 0
    command.out.unlink()

    def refuse(_):
        raise OdometryError("the positions do not tell the yaw")

    monkeypatch.setattr(heading, "headed", refuse)
    code, output, messages = command(curvy_run, *SHORT, "--picture", picture)
    assert code == 0
    assert "Note: no picture is drawn: the positions do not tell the yaw" in messages
    assert f"Wrote {command.out}" in output
    assert f"Wrote {picture}" not in output
    assert not picture.exists()


def test_an_interrupt_while_it_is_drawn_says_that_the_set_is_written(
    command, curvy_run, tmp_path, monkeypatch
):
    def stop(_):
        raise Interrupted(signal.SIGINT)

    monkeypatch.setattr(heading, "headed", stop)
    code, _, messages = command(curvy_run, *SHORT, "--picture", tmp_path / "icrs.png")
    assert code == 130
    assert f"Interrupted: {command.out} was written and is whole" in messages
    assert command.out.is_file()
