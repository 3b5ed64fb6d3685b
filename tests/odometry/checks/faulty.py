"""Faults put into a recording in memory; each names the finding that must come first."""

from dataclasses import replace

import numpy as np


def doubled_later(values):
    """Twice the values in the last 60 %."""
    return values * np.where(np.arange(len(values)) > 0.4 * len(values), 2.0, 1.0)


def put(run, table, **columns):
    of = getattr(run, table)
    return replace(run, **{table: replace(of, columns={**of.columns, **columns})})


def treads(run, change):
    left, right = change(run.odometry["v_left"], run.odometry["v_right"])
    return put(run, "odometry", v_left=left, v_right=right)


def yaw(run, change):
    return put(run, "pose", yaw=change(run.pose["yaw"]))


def positions(run, change):
    x, y = change(run.pose["x"], run.pose["y"])
    return put(run, "pose", x=x, y=y)


def gyroscope(run, change):
    return put(run, "odometry", gyro_z=change(run.odometry["gyro_z"]))


def width(run, factor):
    return replace(run, robot=replace(run.robot, track_width=run.robot.track_width * factor))


def pose_stamps(run, change):
    return put(run, "pose", t=change(run.pose["t"]))


def stuck(run, side):
    speeds = run.odometry[side].copy()
    begin, end = int(0.45 * len(speeds)), int(0.75 * len(speeds))
    speeds[begin:end] = speeds[begin]
    return put(run, "odometry", **{side: speeds})


def spike(run, speed):
    left = run.odometry["v_left"].copy()
    left[len(left) // 3] = speed
    return put(run, "odometry", v_left=left)


def jump(run, size):
    x = run.pose["x"].copy()
    x[len(x) // 2 + 7 :] += size
    return put(run, "pose", x=x)


def frozen(run):
    count = len(run.pose)
    begin, end = int(0.2 * count), int(0.4 * count)
    columns = {name: run.pose[name].copy() for name in ("x", "y", "yaw")}
    for column in columns.values():
        column[begin:end] = column[begin]
    return put(run, "pose", **columns)


def outliers(run):
    rng = np.random.default_rng(0)
    x = run.pose["x"].copy()
    rows = rng.choice(len(x), len(x) // 40, replace=False)
    x[rows] += rng.choice([-4.0, 4.0], len(rows))
    return put(run, "pose", x=x)


def without_rows(run, share):
    rows = np.ones(len(run.odometry), dtype=bool)
    begin = int(0.5 * len(rows))
    rows[begin : begin + int(share * len(rows))] = False
    columns = {name: column[rows] for name, column in run.odometry.columns.items()}
    table = replace(run.odometry, columns=columns, lines=run.odometry.lines[rows])
    return replace(run, odometry=table)


def half_angle(angle):
    return np.sin(np.angle(np.exp(1j * angle)) / 2)


def without_gyroscope(run):
    columns = {name: c for name, c in run.odometry.columns.items() if name != "gyro_z"}
    return replace(run, odometry=replace(run.odometry, columns=columns))


def without_yaw(run, share=1.0, seed=1):
    lost = np.random.default_rng(seed).random(len(run.pose)) < share
    return put(run, "pose", yaw=np.where(lost, np.nan, run.pose["yaw"]))


def later(run, names, seconds):
    at_s = run.odometry.stamps_s
    moved = {name: np.interp(at_s - seconds, at_s, run.odometry[name]) for name in names}
    return put(run, "odometry", **moved)


def late(run, names, seconds):
    def of(name):
        values = np.unwrap(run.pose[name]) if name == "yaw" else run.pose[name]
        return np.interp(run.pose["t"] - seconds, run.pose["t"], values)

    return put(run, "pose", **{name: of(name) for name in names})


def held(run, name, begin_s, end_s, value=None):
    """One tread as at the beginning of a time, or at a value, until the end of it."""
    at_s = run.odometry.stamps_s - run.odometry.stamps_s[0]
    rows = (at_s >= begin_s) & (at_s < end_s)
    value = run.odometry[name][np.argmax(rows)] if value is None else value
    return put(run, "odometry", **{name: np.where(rows, value, run.odometry[name])})


def limited(run, name, change):
    return put(run, "odometry", **{name: change(run.odometry[name])})


SENSORS = {
    "gyroscope and poses": lambda run: run,
    "gyroscope": lambda run: replace(run, pose=None),
    "poses": without_gyroscope,
}


FAULTS = {
    "yaw_in_degrees": lambda run: yaw(run, np.degrees),
    "yaw_reversed": lambda run: yaw(run, np.negative),
    "yaw_off_by_90": lambda run: yaw(run, lambda angle: angle + np.pi / 2),
    "yaw_backwards": lambda run: yaw(run, lambda angle: angle + np.pi),
    "yaw_offset": lambda run: yaw(run, lambda angle: angle + 0.7),
    "yaw_constant": lambda run: yaw(run, np.zeros_like),
    "yaw_is_quaternion": lambda run: yaw(run, half_angle),
    "pose_mirrored": lambda run: yaw(positions(run, lambda x, y: (x, -y)), np.negative),
    "positions_mirrored": lambda run: positions(run, lambda x, y: (y, x)),
    "position_unit": lambda run: positions(run, lambda x, y: (1000 * x, 1000 * y)),
    "latitude_longitude": lambda run: positions(run, lambda x, y: (x / 1.1e5, y / 1.1e5)),
    "treads_swapped": lambda run: treads(run, lambda left, right: (right, left)),
    "tread_left_reversed": lambda run: treads(run, lambda left, right: (-left, right)),
    "tread_right_reversed": lambda run: treads(run, lambda left, right: (left, -right)),
    "treads_both_reversed": lambda run: treads(run, lambda left, right: (-left, -right)),
    "tread_unit": lambda run: treads(run, lambda left, right: (1000 * left, 1000 * right)),
    "scale": lambda run: treads(run, lambda left, right: (left / 2.4, right / 2.4)),
    "treads_unequal": lambda run: treads(run, lambda left, right: (1.3 * left, right)),
    "treads_are_twist": lambda run: treads(
        run, lambda left, right: ((left + right) / 2, (right - left) / 1.8)
    ),
    "treads_equal": lambda run: treads(run, lambda left, _: (left, left)),
    "tread_scale_changed": lambda run: treads(
        run, lambda left, right: (doubled_later(left), doubled_later(right))
    ),
    "gyroscope_unit": lambda run: gyroscope(run, np.degrees),
    "gyroscope_reversed": lambda run: gyroscope(run, np.negative),
    "gyroscope_clipped": lambda run: gyroscope(run, lambda rate: np.clip(rate, -0.15, 0.15)),
    "pose_late": lambda run: pose_stamps(run, lambda t: t + 0.45),
    "clocks_apart": lambda run: pose_stamps(run, lambda t: t[0] + 1.012 * (t - t[0])),
    "stuck_encoder": lambda run: stuck(run, "v_left"),
    "absurd_speed": lambda run: spike(run, 50.0),
    "pose_jumps": lambda run: jump(run, 8.0),
    "frozen_poses": frozen,
    "pose_outliers": outliers,
    "track_width": lambda run: width(run, 10),
    "coarse_speeds": lambda run: treads(
        run, lambda left, right: (np.round(left / 0.25) * 0.25, np.round(right / 0.25) * 0.25)
    ),
    "odometry_gap": lambda run: without_rows(run, 0.15),
    "treads_still": lambda run: treads(run, lambda left, right: (0 * left, 0 * right)),
    "stamp_unit": lambda run: put(
        pose_stamps(run, lambda t: 1e9 * t), "odometry", t=1e9 * run.odometry["t"]
    ),
    "files_apart": lambda run: pose_stamps(run, lambda t: t + 3600.0),
}
