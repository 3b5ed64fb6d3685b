"""Clean drives across terrains, by formulas: slip and ICRs change where the robot is.

Nothing is at fault in them. Robots are 0.25 to 2 m wide, terrains lie in two to five strips with
bent edges, and both sides slip by shares of their own on each. A robot weaves across them, or goes
to and fro between them, with spins, stops and reversals.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

ASYMMETRIES = (0.01, 0.03, 0.05)  # deviation of a side's slip factor from terrain to terrain


@dataclass(frozen=True)
class Drive:
    """A robot, the strips that it crosses, and how it is driven."""

    width_m: float
    speed_m_s: float
    way: str
    asymmetry: float
    strips: list
    edges_m: np.ndarray
    twist: Callable
    lasts_s: float
    heading_rad: float


def write_drive_across(folder, seed):
    """Write a run folder; returns the drive. A seed gives its bytes."""
    rng = np.random.default_rng([991, seed])
    drive = _drawn(rng)
    _write(rng, folder, drive, _simulated(rng, drive))
    return drive


def _drawn(rng):
    width_m = float(np.exp(rng.uniform(np.log(0.25), np.log(2.0))))
    speed_m_s = float(np.clip(width_m * rng.uniform(0.4, 2.2), 0.1, 3.5))
    asymmetry = float(rng.choice(ASYMMETRIES))
    terrains = [_terrain(rng, width_m, asymmetry) for _ in range(rng.integers(2, 4))]
    strips = [terrains[k % len(terrains)] for k in range(rng.integers(2, 6))]
    way = str(rng.choice(["weave", "to and fro", "to and fro"]))
    robot = (width_m, speed_m_s, way, asymmetry, strips)
    strip_m = speed_m_s * rng.uniform(9, 25)
    if way == "weave":
        edges_m = np.cumsum(strip_m * rng.uniform(0.6, 1.4, len(strips) - 1))
        lasts_s = 4 + (edges_m[-1] + strip_m) / speed_m_s
        return Drive(*robot, edges_m, _weave(rng, width_m, speed_m_s), lasts_s, 0.0)
    edges_m = np.cumsum(strip_m * rng.uniform(0.3, 0.8, len(strips) - 1)) - strip_m / 2
    twist = _segments(rng, width_m, speed_m_s)
    return Drive(*robot, edges_m, twist, rng.uniform(80, 240), rng.uniform(-3, 3))


def _terrain(rng, width_m, asymmetry):
    """y_left, y_right, x_icr and both slip factors."""
    half_m, slip = width_m * rng.uniform(1.1, 2.4) / 2, rng.uniform(0.88, 1.0)
    y_left, y_right = half_m * (1 + rng.normal(0, 0.05, 2)) * [1, -1]
    return y_left, y_right, width_m * rng.normal(0, 0.1), slip * (1 + rng.normal(0, asymmetry, 2))


def _weave(rng, width_m, speed_m_s):
    """Along x, with a wave of the heading."""
    swing_rad, period_s = rng.uniform(0.2, 0.9), rng.uniform(6, 16)

    def twist(at_s, pose):
        if at_s < 2:
            return 0.0, 0.0
        phase = 2 * np.pi * at_s / period_s
        wanted = swing_rad * np.sin(phase) - np.clip(pose[1] / (4 * width_m), -0.6, 0.6)
        most = speed_m_s / width_m
        turn = np.clip(1.2 * most * (wanted - pose[2]), -most, most)
        return speed_m_s * (1 + 0.15 * np.sin(0.37 * phase)), turn

    return twist


def _segments(rng, width_m, speed_m_s):
    """Some seconds each of a stop, a spin, a straight, a reversal or an arc."""
    now = {"until_s": 0.0, "twist": (0.0, 0.0)}

    def twist(at_s, _pose):
        if at_s >= now["until_s"]:
            kind, speed = rng.random(), speed_m_s * rng.uniform(0.4, 1.1)
            side = rng.choice([-1, 1])
            now["until_s"] = at_s + rng.uniform(3, 8)
            if kind < 0.12:
                now["twist"] = 0.0, 0.0
            elif kind < 0.3:
                now["twist"] = 0.0, side * speed_m_s * rng.uniform(0.6, 1.2) / width_m
            elif kind < 0.45:
                now["twist"] = speed, 0.0
            elif kind < 0.53:
                now["twist"] = -0.6 * speed, rng.normal(0, 0.2) * speed_m_s / width_m
            else:
                now["twist"] = speed, side * speed / (width_m * rng.uniform(1, 8))
        return now["twist"]

    return twist


def _simulated(rng, drive):
    """Stamps (N,), poses (N, 3), tread speeds (N, 2) and yaw rates (N,)."""
    step_s, noise = 1 / float(rng.choice([10, 20, 25, 50])), rng.uniform(0.01, 0.05)
    stamps_s = np.arange(0, drive.lasts_s, step_s)
    width_m, most = drive.width_m, 3 * drive.speed_m_s * step_s
    pose, treads, rows = np.array([0.0, 0.0, drive.heading_rad]), np.zeros(2), []
    for at_s in stamps_s:
        speed, turn = drive.twist(at_s, pose)
        wanted = speed + np.array([-0.7, 0.7]) * width_m * turn
        treads = treads + np.clip(wanted - treads, -most, most)
        bent_m = pose[0] - 0.1 * width_m * np.sin(pose[1] / (1.5 * width_m) + 0.7)
        y_left, y_right, x_icr, slips = drive.strips[int(np.searchsorted(drive.edges_m, bent_m))]
        left, right = treads * slips
        omega = (right - left) / (y_left - y_right)
        v_x = (right * y_left - left * y_right) / (y_left - y_right)
        turning = abs(omega) + 0.02 * drive.speed_m_s / width_m
        omega += 0.1 * noise * rng.normal() * turning / step_s**0.5
        rows.append([*pose, *treads, omega])
        middle, v_y = pose[2] + omega * step_s / 2, -x_icr * omega
        cos, sin = np.cos(middle), np.sin(middle)
        pose = pose + step_s * np.array([cos * v_x - sin * v_y, sin * v_x + cos * v_y, omega])
    table = np.array(rows)
    return stamps_s, table[:, :3], table[:, 3:5], table[:, 5]


def _write(rng, folder, drive, motion):
    stamps_s, poses, treads, omega = motion
    folder.mkdir(parents=True)
    length_m = drive.width_m * rng.uniform(1, 1.6)
    sizes = f"track_width = {drive.width_m:.3f}\nlength = {length_m:.3f}\n"
    (folder / "run.toml").write_text(f"[robot]\n{sizes}")
    treads = treads + rng.normal(0, 0.004 * drive.speed_m_s, treads.shape)
    header, columns = "t,v_left,v_right", [stamps_s, *treads.T]
    if rng.random() < 0.75:
        header += ",gyro_z"
        columns.append(omega + rng.normal(0, 0.003) + rng.normal(0, 0.004, len(omega)))
    _csv(folder / "odometry.csv", header, columns)
    at_s = np.arange(rng.uniform(0, 0.02), stamps_s[-1], 1 / rng.choice([1, 2, 5, 10]))
    sigma_m = rng.choice([0.01, 0.02, 0.05]) * min(1.0, drive.width_m / 0.5)
    x, y, yaw = (np.interp(at_s, stamps_s, of) for of in poses.T)
    yaw = np.angle(np.exp(1j * (yaw + rng.normal(0, 0.006, len(yaw)))))
    x, y = (of + rng.normal(0, sigma_m, len(of)) for of in (x, y))
    has_yaw = rng.random() < 0.7
    _csv(folder / "pose.csv", "t,x,y,yaw", [at_s, x, y, yaw if has_yaw else np.nan * yaw])


def _csv(file, header, columns):
    lines = [
        ",".join("" if np.isnan(v) else f"{v:.6f}" for v in row)
        for row in zip(*columns, strict=True)
    ]
    file.write_text("\n".join([header, *lines]) + "\n")
