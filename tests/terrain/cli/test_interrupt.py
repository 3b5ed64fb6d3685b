"""Interrupts, a full disk and a closed pipe: one line that is true, and the right exit code."""

import errno
import os
import resource
import signal
import subprocess
import sys
import tempfile
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.bags.rows.pose_rows import Attitudes
from odometry.errors import OutputError
from odometry.outputs.manifest import read_manifest
from odometry.outputs.output_folder import OutputFolder
from odometry.outputs.provenance import Made

MADE = Made("simulate", "", {}, (), {})

SETUP = """
import os, signal, resource
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have it ignored
from pathlib import Path
from terrain.cli.main import main
import odometry.simulation.record as record
from odometry.outputs.output_folder import OutputFolder
"""
STOP = "os.kill(os.getpid(), signal.{signal})"
WHILE = {
    "working": """
import terrain.cli.verbs.simulate
def stop(*a, **k):
    {stop}
import odometry.simulation.contact.drive as drive
drive.simulate_contact = stop
""",
    "writing": """
kept = record.write_run_folder
def write(*a):
    kept(*a)
    {stop}
record.write_run_folder = write
""",
    "moving": """
kept = Path.replace
def replace(self, target):
    moved = kept(self, target)
    if str(target).endswith("pose.csv") and ".unfinished" not in str(target):
        {stop}
    return moved
Path.replace = replace
""",
}


def simulate(setup, out, seed="1", **options):
    program = f"{SETUP}\n{setup}\nmain()"
    arguments = ["simulate", "--out", out, "--duration", "3", "--seed", seed]
    return subprocess.run(
        [sys.executable, "-c", program, *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
        **options,
    )


@pytest.mark.parametrize(
    ("moment", "name"),
    [("working", "SIGINT"), ("working", "SIGTERM"), ("writing", "SIGTERM"), ("moving", "SIGINT")],
)
def test_an_interrupt_says_in_one_line_what_it_left(tmp_path, moment, name):
    out = tmp_path / "run"
    code, word = {"SIGINT": (130, "Interrupted"), "SIGTERM": (143, "Terminated")}[name]
    answer = simulate(WHILE[moment].format(stop=STOP.format(signal=name)), out)
    assert answer.returncode == code, answer.stderr
    if moment == "moving":
        assert answer.stderr == f"{word}: {out} is unfinished: run the command again\n"
        assert read_manifest(out).state == "unfinished"
        assert simulate("", out).returncode == 0
        assert read_manifest(out).state == "finished"
    else:
        said = f"nothing was written to {out}" if moment == "writing" else "nothing was written"
        assert answer.stderr == f"{word}: {said}\n"
        assert not out.exists()


def test_an_interrupt_after_the_output_says_that_it_is_whole(tmp_path):
    """`import` still checks the run that it wrote; `simulate` stands for it here."""
    out = tmp_path / "run"
    after = """
import click
def echo(*a, **k):
    click.echo = kept
    {stop}
kept, click.echo = click.echo, echo
""".format(stop=STOP.format(signal="SIGINT"))
    answer = simulate(after, out)
    assert answer.returncode == 130
    assert answer.stderr == (
        f"Interrupted: {out} was written and is whole; only what follows it is missing\n"
    )
    assert read_manifest(out).state == "finished"


def test_an_interrupt_over_an_earlier_result_keeps_it(tmp_path):
    out = tmp_path / "run"
    assert simulate("", out).returncode == 0
    before = {path: path.read_bytes() for path in out.iterdir()}
    stop = WHILE["writing"].format(stop=STOP.format(signal="SIGINT"))
    answer = simulate(stop, out, seed="2")
    assert answer.stderr == f"Interrupted: {out} holds the earlier result, unchanged\n"
    assert {path: path.read_bytes() for path in out.iterdir()} == before


def test_a_second_interrupt_ends_the_process_at_once(tmp_path):
    twice = f"try:\n        {STOP}\n    finally:\n        {STOP}"
    answer = simulate(WHILE["working"].format(stop=twice.format(signal="SIGINT")), tmp_path / "run")
    assert answer.returncode == -signal.SIGINT


def test_a_full_disk_names_the_file_and_leaves_nothing(tmp_path):
    """The limit on the size of a file stands for the disk: the same call fails."""
    out = tmp_path / "run"
    answer = simulate("resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))", out)
    assert answer.returncode == 1
    assert answer.stderr == f"Error: cannot write {out / 'odometry.csv'}: File too large\n"
    assert not out.exists()
    assert resource.getrlimit(resource.RLIMIT_FSIZE)[0] != 4000


@pytest.mark.parametrize("named", ["odometry.csv", None])
def test_a_full_disk_of_a_plain_stream_names_the_place(tmp_path, named):
    """As `import` and the MCAP of `export` write: the system names no file when it flushes."""
    out = tmp_path / "run"

    def fill(part):
        name = None if named is None else str(part / named)
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), name)

    with pytest.raises(OutputError) as error, OutputFolder(out, MADE, ()).writing() as part:
        fill(part)
    place = out if named is None else out / named
    assert str(error.value) == f"cannot write to {place}: No space left on device"
    assert not out.exists()


def test_a_full_disk_of_temporary_files_says_which_and_what_to_set(monkeypatch):
    def full(_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    attitudes = Attitudes(np.eye(3))
    attitudes.close()
    monkeypatch.setattr(attitudes, "_file", SimpleNamespace(write=full))
    with pytest.raises(OutputError) as error:
        attitudes.add(np.array([1, 2]), np.tile([1.0, 0, 0, 0], (2, 1)), np.empty((2, 0)))
    assert tempfile.gettempdir() in str(error.value)
    assert "TMPDIR" in str(error.value)


def test_another_error_while_writing_keeps_its_own_message(tmp_path):
    missing = OSError(errno.ENOENT, os.strerror(errno.ENOENT), "an_input.csv")
    with (
        pytest.raises(FileNotFoundError, match=r"an_input\.csv"),
        OutputFolder(tmp_path / "run", MADE, ()).writing(),
    ):
        raise missing


@pytest.mark.slow
def test_a_closed_pipe_is_no_message(tmp_path):
    """What reads the output has ended before the first line."""
    reading, writing = os.pipe()
    os.close(reading)
    program = "from terrain.cli.main import main; main()"
    answer = subprocess.run(
        [sys.executable, "-c", program, "evaluate", "--json", str(tmp_path)],
        stdout=writing,
        stderr=subprocess.PIPE,
        check=False,
    )
    os.close(writing)
    assert answer.stderr == b""
