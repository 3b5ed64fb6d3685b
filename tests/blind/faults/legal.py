"""Legal changes of a recording: what a robot may record without anything being wrong."""

import math

import cv2
import numpy as np

from tests.blind.faults.fault import gyro_bias, held


def as_it_is(recording, rng):  # noqa: ARG001
    return recording


def epoch(recording, rng):
    start = 1.7e9 + rng.uniform(0, 3e7)
    return recording.restamped(lambda t: t + start)


def common_offset(recording, rng):
    start = rng.choice([-1, 1]) * rng.uniform(1, 1e5)
    return recording.restamped(lambda t: t + start)


def on_change(recording, rng):  # noqa: ARG001
    """Rows only where a tread speed changes by 0.02 m/s or more; the gyroscope has its own file."""
    table = recording["odometry"]
    left, right, keep, last = table["v_left"], table["v_right"], [], (math.inf, math.inf)
    for row in range(len(left)):
        if max(abs(left[row] - last[0]), abs(right[row] - last[1])) >= 0.02:
            keep.append(row)
            last = left[row], right[row]
    thinned = recording.with_table("odometry", {n: table[n] for n in ("t", "v_left", "v_right")})
    thinned = thinned.with_rows("odometry", np.array(keep))
    if "gyro_z" in table and "imu" not in recording:
        thinned = thinned.with_table("imu", {n: table[n] for n in ("t", "gyro_z")})
    return thinned


def other_rate(recording, rng):
    table, rate = recording["odometry"], rng.uniform(8, 60)
    t = np.arange(table["t"][0], table["t"][-1], 1 / rate)
    return recording.with_table(
        "odometry", {n: t if n == "t" else held(t, table["t"], c) for n, c in table.items()}
    )


def more_columns(recording, rng):
    count = len(recording["odometry"]["t"])
    return recording.with_columns(
        "odometry", battery=np.full(count, 24.7), joystick=rng.uniform(-1e4, 1e4, count)
    )


def long_start(recording, rng):
    """One to four minutes at rest before the drive, with the noise of a robot at rest."""
    wait, result = rng.uniform(60, 240), recording
    at_rest = {"v_left": 0.0, "v_right": 0.0}
    if "gyro_z" in recording["odometry"]:
        at_rest["gyro_z"] = gyro_bias(recording)
    for name, table in recording.tables.items():
        t, quiet = table["t"], {}
        step = np.median(np.diff(t))
        early = np.arange(t[0], t[0] + wait - step / 2, step)
        for column, values in table.items():
            if column == "t":
                quiet[column] = np.r_[early, t + wait]
            elif column == "window" or values.dtype == object:
                quiet[column] = np.concatenate([np.repeat(values[:1], len(early)), values])
            else:
                first = at_rest.get(column, values[0])
                noise = 0.0 if column.startswith("v_") else 0.002
                quiet[column] = np.r_[first + rng.normal(0, noise, len(early)), values]
        result = result.with_table(name, quiet)
    return result


def slow_poses(recording, rng):
    """Poses at about 1 Hz, a fifth of them lost."""
    t = recording["pose"]["t"]
    seconds = np.floor(t - t[0])
    keep = np.r_[True, np.diff(seconds) > 0] & (rng.random(len(t)) < 0.8)
    keep[[0, -1]] = True
    return recording.with_rows("pose", keep)


def other_world(recording, rng):
    pose, turn = recording["pose"], rng.uniform(-math.pi, math.pi)
    x, y = rng.normal(0, 100, 2)
    cos, sin = math.cos(turn), math.sin(turn)
    return recording.with_columns(
        "pose",
        x=x + cos * pose["x"] - sin * pose["y"],
        y=y + sin * pose["x"] + cos * pose["y"],
        yaw=pose["yaw"] + turn,
    )


def utm(recording, rng):
    pose = recording["pose"]
    east, north = rng.uniform(2e5, 8e5), rng.uniform(4e6, 7e6)
    return recording.with_columns("pose", x=pose["x"] + east, y=pose["y"] + north)


def wrapped(recording, rng):
    yaw = np.angle(np.exp(1j * recording["pose"]["yaw"]))
    return recording.with_columns("pose", yaw=yaw % (2 * math.pi) if rng.random() < 0.5 else yaw)


def more_turns(recording, rng):
    turns = 2 * math.pi * rng.integers(1, 40)
    return recording.with_columns("pose", yaw=recording["pose"]["yaw"] + turns)


def no_gyro(recording, rng):  # noqa: ARG001
    names = ("t", "v_left", "v_right")
    return recording.with_table("odometry", {n: recording["odometry"][n] for n in names})


def no_pose(recording, rng):  # noqa: ARG001
    return recording.without("pose")


def no_yaw(recording, rng):  # noqa: ARG001
    return recording.with_columns("pose", yaw=np.full(len(recording["pose"]["t"]), math.nan))


def yaw_at_times(recording, rng):
    """A yaw in a third to two thirds of the rows: two antennas that see enough at times."""
    t, yaw = recording["pose"]["t"], recording["pose"]["yaw"].copy()
    begin, length = rng.uniform(0.0, 0.3), rng.uniform(0.33, 0.67)
    share = (t - t[0]) / (t[-1] - t[0])
    without = (share > begin) & (share < begin + length)
    if rng.random() < 0.5:
        without = rng.random(len(t)) < length
    yaw[without] = math.nan
    return recording.with_columns("pose", yaw=yaw)


def gnss_alone(recording, rng):
    """Single positions of a receiver: 1 to 5 Hz, a noise of 2 cm to 0.3 m, no yaw."""
    pose, rate, sigma = recording["pose"], rng.uniform(1, 5), rng.choice([0.02, 0.1, 0.3])
    t = pose["t"]
    place = np.floor((t - t[0]) * rate)
    kept = recording.with_rows("pose", np.r_[True, np.diff(place) > 0])
    count = len(kept["pose"]["t"])
    noise = rng.normal(0, sigma, (2, count))
    return kept.with_columns(
        "pose",
        x=kept["pose"]["x"] + noise[0],
        y=kept["pose"]["y"] + noise[1],
        yaw=np.full(count, math.nan),
    )


def pose_dropouts(recording, rng):
    """No poses for a tenth of the run: out of sight of the satellites, which is legal."""
    t = recording["pose"]["t"]
    start = t[0] + (t[-1] - t[0]) * rng.uniform(0.1, 0.8)
    return recording.with_rows("pose", (t < start) | (t > start + 0.1 * (t[-1] - t[0])))


def many_windows(recording, rng):
    count = len(recording["pose"]["t"])
    numbers = np.cumsum(rng.random(count) < 0.01) + rng.integers(0, 1000)
    return recording.with_columns("pose", window=numbers)


def one_repeated_row(recording, rng):
    count = len(recording["odometry"]["t"])
    rows = np.sort(np.r_[np.arange(count), rng.integers(0, count)])
    return recording.with_rows("odometry", rows)


def backwards(recording, rng):  # noqa: ARG001
    """The same drive in reverse: the last moment first, all speeds with the other sign."""
    result = recording
    for name, table in recording.tables.items():
        flipped = {column: values[::-1] for column, values in table.items()}
        for column in ("v_left", "v_right", "gyro_x", "gyro_y", "gyro_z", "vx", "vy", "wz"):
            if column in flipped:
                flipped[column] = -flipped[column]
        end = max(other["t"][-1] for other in recording.tables.values())
        result = result.with_table(name, flipped | {"t": end - flipped["t"]})
    return result


def png(recording, rng):
    """Images without loss, in grey or in colour."""
    flag = rng.choice([cv2.IMREAD_GRAYSCALE, cv2.IMREAD_COLOR])
    result, names = recording, []
    for name in recording["images"]["file"]:
        content = cv2.imencode(".png", cv2.imread(str(recording.folder / name), flag))[1].tobytes()
        names.append(name.rsplit(".", 1)[0] + ".png")
        result = result.with_file(name, None).with_file(names[-1], content)
    return result.with_columns("images", file=np.array(names, object))


def carriage_returns(recording, rng):  # noqa: ARG001
    content = (recording.folder / "odometry.csv").read_bytes()
    return recording.with_file("odometry.csv", content.replace(b"\r", b"").replace(b"\n", b"\r\n"))
