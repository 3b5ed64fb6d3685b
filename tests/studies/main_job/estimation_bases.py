"""Recordings on which faults are drawn: real ones, and simulated ones with their truth."""

import shutil
import subprocess
import sys
from pathlib import Path

from tests.blind.faults.recordings import read_recording

LONGEST_S = 110.0
REAL = {
    "grass": "warthog_grass_20240729_1446",
    "tile": "husky_tile_20231212_1616_s00",
    "boreal": "marmotte_boreal_20240125_1215_s00",
    "asphalt": "warthog_asphalt_20240920_0813",
}
SIMULATED = {
    "sim_husky": "--seed 21 --duration 110",
    "sim_warthog": "--vehicle warthog_like --drive figure_eight --max-speed 2 --seed 22 "
    "--duration 110",
}
PROGRAM = "from terrain.cli.main import main; main()"


def bases(data, scratch, names=None):
    """Recordings by name, each at most LONGEST_S long."""
    found = {}
    for name in names or (*REAL, *SIMULATED):
        if name in REAL:
            found[name] = shortened(read_recording(Path(data) / "motion" / REAL[name]))
        else:
            found[name] = read_recording(simulated(Path(scratch) / name, SIMULATED[name]))
    return found


def simulated(folder, options):
    """A run by `simulate`, made once, without its figures."""
    if not folder.exists():
        unfinished = folder.with_name(f"{folder.name}_unfinished")
        shutil.rmtree(unfinished, ignore_errors=True)
        command = ["simulate", *options.split(), "--out", str(unfinished)]
        subprocess.run([sys.executable, "-c", PROGRAM, *command], check=True, capture_output=True)
        unfinished.rename(folder)
    return folder


def shortened(recording, longest_s=LONGEST_S):
    """The first part of a recording."""
    end_s = recording["odometry"]["t"][0] + longest_s
    for name, table in recording.tables.items():
        recording = recording.with_rows(name, table["t"] <= end_s)
    return recording
