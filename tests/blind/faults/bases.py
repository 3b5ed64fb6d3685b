"""Clean recordings: real ones, and simulated ones made by the command line.

Two halves share no drive: of a recording that was cut into segments, all are in one half.
"""

import shutil
import subprocess
import sys
from dataclasses import dataclass
from functools import cache as remember
from pathlib import Path

import numpy as np

from tests.blind.faults.fault import integral
from tests.blind.faults.recordings import read_recording

GOOD_POSE = ("warthog_grass", "warthog_asphalt_20240920", "husky_tile", "marmotte", "warthog_2023")
FIRST = (
    "husky_tile",
    "warthog_grass_20240729_1404",
    "warthog_grass_20240808_1556",
    "warthog_2023",
    "warthog_asphalt_slow",
    "warthog_gravel",
    "warthog_sand",
    "husky_borealtc_asphalt",
    "husky_borealtc_flooring",
    "feel/asphalt",
    "feel/flooring",
    "feel/sandy_loam",
)
SECOND = (
    "marmotte",
    "warthog_grass_20240729_1446",
    "warthog_asphalt_20240920",
    "warthog_asphalt_fast",
    "warthog_ice",
    "husky_2023",
    "husky_borealtc_ice",
    "husky_borealtc_snow",
    "feel/ice",
    "feel/snow",
)
TILTED = "--drive tour --slope 8"
SIMULATED = {
    "first": {
        "husky_like": "--seed 1 --duration 120",
        "auriga": "--vehicle auriga_alpha --drive figure_eight --seed 2 --duration 120",
        "j8_slope": f"--vehicle j8 {TILTED} --seed 3",
    },
    "second": {
        "warthog_like": "--vehicle warthog_like --max-speed 3 --seed 4 --duration 120",
        "lazaro": "--vehicle lazaro --drive figure_eight --seed 5 --duration 120",
        "husky_slope": f"--vehicle husky_like {TILTED} --seed 6",
    },
    "clean": {
        "skidpad": "--drive skidpad --seed 7",
        "clothoid": "--vehicle warthog_like --drive clothoid --seed 8",
        "sinusoid": "--drive sinusoid --traction grass --traction asphalt@80 --seed 9",
        "spin": "--vehicle j8 --drive spin --seed 10",
        "spiral": "--vehicle auriga_alpha --drive outward_spiral --seed 11",
        "coulomb": "--law coulomb --friction 0.4 --seed 12",
        "fast": "--vehicle warthog_like --max-speed 4 --drive excitation --seed 13",
        "steep": "--vehicle lazaro --drive figure_eight --slope 12 --seed 14",
    },
}
PROGRAM = "from terrain.cli.main import main; main()"
SYNTHESISED = {"first": "--seed 3", "second": "--seed 8 --zone grass --zone brick --zone grass"}


@dataclass(frozen=True)
class Base:
    """A clean recording: its name, where it is and what it has."""

    name: str
    folder: Path
    has: frozenset


def real_bases(data, half):
    """Recordings of one half ("first", "second") or of both ("all")."""
    data = Path(data)
    starts = {"first": FIRST, "second": SECOND, "all": FIRST + SECOND}[half]
    motion = [(folder.name, folder) for folder in sorted((data / "motion").glob("*/"))]
    feel = [(f"feel/{folder.name}", folder) for folder in sorted((data / "feel").glob("*/"))]
    return [
        Base(name, folder, traits(name, folder))
        for name, folder in motion + feel
        if name.startswith(starts)
    ]


def simulated_bases(cache, half):
    """Runs by `simulate`, and one with images by `synthesise`; made once in the cache."""
    halves = ("first", "second") if half == "all" else (half,)
    bases = []
    for part in halves:
        for name, options in SIMULATED[part].items():
            bases.append(_made(cache, f"simulated_{name}", ["simulate", *options.split()]))
        if part in SYNTHESISED:
            options = ["synthesise", "--image-rate", "2", *SYNTHESISED[part].split()]
            bases.append(_made(cache, f"synthesised_{part}", options))
    truth = bases[0]
    bases.append(Base(f"{truth.name}_with_truth", Path(cache) / "truth", frozenset({"truth"})))
    _copy_with_truth(truth.folder, bases[-1].folder)
    return bases


def _made(cache, name, command):
    folder = Path(cache) / name
    if not folder.exists():
        unfinished = folder.with_name(f"{name}_unfinished")
        shutil.rmtree(unfinished, ignore_errors=True)
        program = [sys.executable, "-c", PROGRAM, *command, "--out", str(unfinished)]
        subprocess.run(program, check=True, capture_output=True)
        shutil.rmtree(unfinished / "patches", ignore_errors=True)
        (unfinished / "truth.csv").rename(unfinished / "truth.kept")
        unfinished.rename(folder)
    return Base(name, folder, traits(name, folder))


def _copy_with_truth(source, folder):
    if not folder.exists():
        shutil.copytree(source, folder)
        (folder / "truth.kept").rename(folder / "truth.csv")


@remember
def traits(name, folder):
    """What a recording has: names that faults need."""
    recording = read_recording(folder)
    odometry = recording["odometry"]
    made = name.startswith(("simulated", "synthesised"))
    found = {
        "pose": "pose" in recording,
        "good pose": "pose" in recording and (made or name.startswith(GOOD_POSE)),
        "gyro": "gyro_z" in odometry,
        "imu": "imu" in recording,
        "imu and turns": "imu" in recording and turns_show(recording),
        "images": "images" in recording,
        "radius": "wheel_radius" in recording.robot,
        "attitude": "roll" in odometry,
        "tilt": "roll" in odometry and _tilted(odometry),
        "turns by gyro only": "pose" not in recording and turns_show(recording),
        "motion": True,
    }  # fmt: skip
    if "images" in recording:  # faults of motion are drawn on recordings of motion
        return frozenset({"images"})
    return frozenset(trait for trait, there in found.items() if there)


def turns_show(recording):
    """Whether the treads' difference and the gyroscope agree (0.7) on the turns in steps of 2 s.

    Stamps of data/feel are made up, apart by tenths of a second; many of its drives are straight.
    """
    table = recording["odometry"]
    gyro = recording.tables.get("imu", table)
    if "gyro_z" not in gyro or np.ptp(table["v_right"] - table["v_left"]) < 0.1:
        return False
    grid = np.arange(table["t"][0], table["t"][-1], 2.0)
    by_gyro = np.diff(np.interp(grid, gyro["t"], integral(gyro["t"], gyro["gyro_z"])))
    difference = integral(table["t"], table["v_right"] - table["v_left"])
    return bool(np.corrcoef(by_gyro, np.diff(np.interp(grid, table["t"], difference)))[0, 1] > 0.7)


def other_segments(recording):
    """Folders of the other segments (_s00, _s01, ...) of the same recording."""
    start, cut, _ = recording.folder.name.rpartition("_s")
    folders = sorted(recording.folder.parent.glob(f"{start}_s*/")) if cut else []
    return [folder for folder in folders if folder.name != recording.folder.name]


def _tilted(odometry):
    """Roll and pitch both vary by more than 2.5 degrees."""
    spread = [np.ptp(np.quantile(odometry[name], [0.05, 0.95])) for name in ("roll", "pitch")]
    return min(spread) > np.deg2rad(2.5)
