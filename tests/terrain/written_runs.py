"""Run folders that are written in full: tables, settings, and a drive that winds about."""

import numpy as np

ROBOT = {"track_width": 0.3, "length": 0.4, "width": 0.34}


def write_csv(file, header, rows):
    lines = [header, *(",".join(f"{value:.9g}" for value in row) for row in rows)]
    file.write_text("\n".join(lines) + "\n")


def write_toml(file, **tables):
    """TOML of tables of numbers, names and lists."""
    lines = []
    for name, table in tables.items():
        lines += [f"[{name}]", *(f"{key} = {value!r}" for key, value in table.items())]
    file.write_text("\n".join(lines).replace("'", '"') + "\n")


def twist(v_left, v_right, y_left, y_right, x_icr):
    """Body twist by data/README.md."""
    width = y_left - y_right
    omega = (v_right - v_left) / width
    return (v_right * y_left - v_left * y_right) / width, -x_icr * omega, omega


def drive_curves(folder, pose=True, truth=False, stamps_s=None):
    """Run folder of a robot that winds about, without images: 12 s, poses at 5 Hz, no noise."""
    folder.mkdir(parents=True)
    write_toml(folder / "run.toml", robot=ROBOT)
    stamps_s = np.arange(0.0, 12.001, 0.05) if stamps_s is None else stamps_s
    left = 0.5 + 0.3 * np.sin(1.3 * stamps_s)
    right = 0.5 + 0.3 * np.cos(0.9 * stamps_s)
    write_csv(folder / "odometry.csv", "t,v_left,v_right", zip(stamps_s, left, right, strict=True))
    poses, fine = [np.array([1.0, 2.0, 0.5])], (np.arange(50) + 0.5) / 50
    for k, step_s in enumerate(np.diff(stamps_s)):
        v_x, v_y, omega = twist(left[k], right[k], 0.26, -0.24, 0.03)
        x, y, yaw = poses[-1]
        middle = yaw + omega * step_s * fine
        cosine, sine = np.cos(middle).mean(), np.sin(middle).mean()
        x += (v_x * cosine - v_y * sine) * step_s
        y += (v_x * sine + v_y * cosine) * step_s
        poses.append(np.array([x, y, yaw + omega * step_s]))
    rows = np.column_stack([stamps_s, poses])
    if pose:
        write_csv(folder / "pose.csv", "t,x,y,yaw", rows[::4])
    if truth:
        write_csv(folder / "truth.csv", "t,x,y,yaw", rows)
    return folder
