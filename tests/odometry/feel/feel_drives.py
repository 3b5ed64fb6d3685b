"""Made drives: band-limited vibration by terrain and speed, without the features in use."""

from functools import cache
from pathlib import Path

import numpy as np
from scipy.signal import butter, sosfilt

from odometry.feel.identify_feel import identify_feel
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table

# centre [Hz], m/s2 at 1 m/s, exponent of speed, share of rotation, yaw gain, current [A]
TERRAINS = {
    "tiles": (18.0, 0.9, 1.0, 0.02, 0.75, 3.0),
    "gravel": (9.0, 1.6, 0.8, 0.05, 0.6, 4.0),
    "snow": (4.0, 1.2, 1.2, 0.04, 0.9, 6.0),
    "grates": (30.0, 3.0, 1.0, 0.01, 0.7, 3.5),
}


MADE_HZ = 400.0


def table(columns):
    count = len(columns["t"])
    return Table(Path("made/imu.csv"), columns, np.arange(2, 2 + count))


def coloured(rng, count, rate_hz, centre_hz):
    """Noise of unit size around a frequency: one motion, whatever the rate it is sampled at."""
    every = round(MADE_HZ / rate_hz)
    sos = butter(4, [centre_hz / 1.4, centre_hz * 1.4], "bandpass", fs=MADE_HZ, output="sos")
    noise = sosfilt(sos, rng.normal(size=count * every))
    return noise[::every] / noise.std()


def drive(
    terrain, seed, *, seconds=30.0, speed=0.5, rate_hz=100.0, turning=0.1, imu=True, **settings
):
    """A run on one terrain: straights and turns, a slow wave of the speed."""
    rng = np.random.default_rng(seed)
    centre, size, power, share, gain, current = TERRAINS[terrain]
    t = np.arange(0.0, seconds, 0.1)
    v = speed * (1 + 0.1 * np.sin(0.4 * t + seed))
    turn = turning * np.sign(np.sin(0.5 * t))
    odometry = {
        "t": t,
        "v_left": v - turn / 2,
        "v_right": v + turn / 2,
        "current_left": current * (1 + 0.1 * rng.normal(size=len(t))) + v,
        "current_right": current * (1 + 0.1 * rng.normal(size=len(t))) + v,
    }
    at = np.arange(0.0, seconds, 1 / rate_hz)
    grown = size * np.interp(at, t, v) ** power * rng.lognormal(0.0, 0.1)
    columns = {"t": at}
    floor = np.sqrt(rate_hz / 100.0)  # the density of a sensor's noise is the same at every rate
    for place, axis in enumerate("xyz"):
        shaken = grown * coloured(rng, len(at), rate_hz, centre * (1 + 0.1 * place))
        columns[f"accel_{axis}"] = shaken + 0.03 * floor * rng.normal(size=len(at))
        turned = grown * share * coloured(rng, len(at), rate_hz, centre * (1 + 0.1 * place))
        columns[f"gyro_{axis}"] = turned + 0.002 * floor * rng.normal(size=len(at))
    columns["accel_z"] += 9.81
    columns["gyro_z"] += gain * np.interp(at, t, turn) / 0.5
    return Run(
        Path(f"made/{terrain}_{seed}"),
        Robot(track_width=0.5, name="made"),
        {"robot": {"track_width": 0.5}, "run": {"terrain": terrain}, **settings},
        table(odometry),
        imu=table(columns) if imu else None,
    )


def drives(names, count=4, **how):
    """Runs on several terrains, all with other seeds."""
    return [
        drive(name, 100 * place + seed, **how)
        for place, name in enumerate(names)
        for seed in range(count)
    ]


@cache
def model_of_three():
    """What three runs each on tiles, gravel and snow teach; not to be changed."""
    return identify_feel(drives(["tiles", "gravel", "snow"], count=3))


def with_imu(run, change):
    """The run with other columns of its IMU."""
    columns = change(dict(run.imu.columns))
    return Run(run.folder, run.robot, run.settings, run.odometry, imu=table(columns))
