"""Faults of gyroscope, accelerometer and attitude."""

import math

import numpy as np

from tests.blind.faults.fault import Fault, UnsuitableError, about, pick_stretch

GOOD = frozenset({"good pose", "gyro"})
IMU = frozenset({"imu"})
TILT = frozenset({"tilt"})
GYRO = ("gyro", "imu", "inertial")
SIGN = ("sign", "revers", "clockwise", "upside", "invert", "opposite", "negat")


def gyro(recording, values):
    return recording.with_columns("odometry", gyro_z=values)


def _times(factor):
    return lambda recording, rng: gyro(recording, recording["odometry"]["gyro_z"] * factor)  # noqa: ARG005


def add_bias(recording, rng):
    bias = rng.choice([-1, 1]) * rng.uniform(0.02, 0.08)
    return gyro(recording, recording["odometry"]["gyro_z"] + bias)


def other_range(recording, rng):
    """The driver assumes another full-scale range of the chip: factor 2 or 4 either way."""
    return _times(rng.choice([0.25, 0.5, 2.0, 4.0]))(recording, rng)


def other_axis(recording, rng):
    """The column holds a horizontal axis: rates of some hundredths, nothing of the turns."""
    count = len(recording["odometry"]["t"])
    white = rng.normal(0, 1, count + 20)
    rates = np.convolve(white, np.hanning(21), "valid")
    return gyro(recording, rates / rates.std() * rng.uniform(0.02, 0.1))


def clip(recording, rng):
    rates = recording["odometry"]["gyro_z"]
    limit = np.quantile(np.abs(rates), 0.995) * rng.uniform(0.3, 0.6)
    if np.mean(np.abs(rates) > 1.15 * limit) < 0.05:
        raise UnsuitableError
    return gyro(recording, np.clip(rates, -limit, limit))


def freeze(recording, rng):
    table = recording["odometry"]
    rates, t = table["gyro_z"], table["t"]

    def turns(mask):
        return np.ptp(rates[mask]) > 0.3

    mask = pick_stretch(rng, t, (0.1, 0.5), (0.1, 0.7), turns)
    return gyro(recording, np.where(mask, rates[np.flatnonzero(mask)[0] - 1], rates))


def delay(recording, rng):
    table, late = recording["odometry"], rng.choice([-1, 1]) * rng.uniform(0.2, 0.6)
    return gyro(recording, np.interp(table["t"] - late, table["t"], table["gyro_z"]))


def put_spike(recording, rng):
    rates = recording["odometry"]["gyro_z"]
    row = rng.integers(1, len(rates) - 1)
    value = rng.choice([-1, 1]) * math.exp(rng.uniform(*np.log([15, 500])))
    return gyro(recording, np.where(np.arange(len(rates)) == row, value, rates))


def negate_pitch(recording, rng):  # noqa: ARG001
    return recording.with_columns("odometry", pitch=-recording["odometry"]["pitch"])


def negate_roll(recording, rng):  # noqa: ARG001
    return recording.with_columns("odometry", roll=-recording["odometry"]["roll"])


def swap_roll_pitch(recording, rng):  # noqa: ARG001
    table = recording["odometry"]
    return recording.with_columns("odometry", roll=table["pitch"], pitch=table["roll"])


def attitude_in_degrees(recording, rng):  # noqa: ARG001
    table = recording["odometry"]
    return recording.with_columns(
        "odometry", roll=np.rad2deg(table["roll"]), pitch=np.rad2deg(table["pitch"])
    )


def imu_gyro_in_degrees(recording, rng):  # noqa: ARG001
    imu = recording["imu"]
    names = [name for name in imu if name.startswith("gyro")]
    return recording.with_columns("imu", **{name: np.rad2deg(imu[name]) for name in names})


def accelerations_in_g(recording, rng):  # noqa: ARG001
    imu = recording["imu"]
    names = [name for name in imu if name.startswith("accel")]
    return recording.with_columns("imu", **{name: imu[name] / 9.80665 for name in names})


def imu_upside_down(recording, rng):  # noqa: ARG001
    """Turned by half a turn about x: y and z of everything have the other sign."""
    names = ("gyro_y", "gyro_z", "accel_y", "accel_z")
    return recording.with_columns("imu", **{name: -recording["imu"][name] for name in names})


def imu_on_its_side(recording, rng):
    """The box stands upright: its z is a horizontal axis of the robot."""
    imu, turned = recording["imu"], {}
    order = [("z", "y", "x"), ("x", "z", "y")][rng.integers(2)]
    for kind in ("gyro", "accel"):
        for axis, source in zip("xyz", order, strict=True):
            sign = -1.0 if (axis, source) in {("x", "z"), ("y", "z")} else 1.0
            turned[f"{kind}_{axis}"] = sign * imu[f"{kind}_{source}"]
    return recording.with_columns("imu", **turned)


# fmt: off
FAULTS = (
    Fault("gyro_bias", "note", "The gyroscope has a bias.", about(GYRO, ("bias", "offset")),
          add_bias, GOOD, named=True, harmless=True),
    Fault("gyro_in_degrees", "warning", "The gyroscope is in degrees a second.",
          ("degree", "deg"), _times(180 / math.pi), GOOD, named=True),
    Fault("gyro_reversed", "warning", "The gyroscope's z points down.",
          about(GYRO, (*SIGN, "down")), _times(-1.0), GOOD, named=True),
    Fault("gyro_of_another_range", "warning", "The gyroscope's scale is 2 or 4 times off.",
          ("scale", "range", "gain", "sensitiv", "factor", "unit"), other_range, GOOD),
    Fault("gyro_of_another_axis", "warning", "gyro_z is a horizontal axis.",
          ("axis", "axes", "mount", "not yaw", "unrelated", "another", "roll", "pitch", "turned"),
          other_axis, GOOD),
    Fault("gyro_clipped", "warning", "The gyroscope is clipped at its range.",
          ("clip", "satur", "range", "limit", "cut"), clip, GOOD),
    Fault("gyro_frozen", "warning", "The gyroscope holds one value for a part of the run.",
          about(GYRO, ("frozen", "froze", "stuck", "hold", "held", "constant", "stop", "hang")),
          freeze, GOOD),
    Fault("gyro_always_zero", "warning", "The gyroscope was never read.",
          about(GYRO, ("zero", "never", "not connect", "constant", "dead", "not measured",
          "placeholder", "frozen", "stuck")), _times(0.0), GOOD),
    Fault("gyro_on_another_clock", "warning", "The gyroscope is late or early.",
          about(GYRO, ("late", "early", "delay", "lag", "behind", "ahead", "clock", "latenc",
          r"time\b", "stamp")), delay, GOOD),
    Fault("gyro_spike", "warning", "One sample of the gyroscope is absurd.",
          about(GYRO, ("spike", "single", "sample", "outlier", "glitch", "absurd", "corrupt",
          "one row", "transmission")), put_spike, frozenset({"gyro"})),
    Fault("pitch_reversed", "warning", "Pitch is positive nose up.",
          about(["pitch"], (*SIGN, "nose")), negate_pitch, TILT, named=True),
    Fault("roll_reversed", "warning", "Roll is positive left side down.",
          about(["roll"], (*SIGN, "side")), negate_roll, TILT, named=True),
    Fault("roll_pitch_swapped", "warning", "Roll and pitch are exchanged.",
          ("swap", "exchang", "interchang", "axes", "mixed"), swap_roll_pitch, TILT),
    Fault("attitude_in_degrees", "warning", "Roll and pitch are in degrees.", ("degree", "deg"),
          attitude_in_degrees, frozenset({"attitude"})),
    Fault("imu_gyro_in_degrees", "warning", "imu.csv has degrees a second.", ("degree", "deg"),
          imu_gyro_in_degrees, frozenset({"imu and turns"})),
    Fault("imu_accelerations_in_g", "warning", "Accelerations are in g.",
          (r"g\b", "gravit", "unit", "9.8"), accelerations_in_g, IMU),
    Fault("imu_upside_down", "warning", "The IMU hangs upside down.",
          ("upside", "down", "sign", "revers", "invert", "mount", "ned"), imu_upside_down, IMU),
    Fault("imu_on_its_side", "warning", "The IMU stands on its side.",
          ("axis", "axes", "mount", "rotat", "side", "upright", "turned"), imu_on_its_side, IMU),
)
# fmt: on
