"""Files that spreadsheets, exports and killed recorders leave behind."""

import math

import numpy as np

from tests.blind.faults.fault import Fault
from tests.blind.faults.recordings import table_text


def semicolons(recording, rng):  # noqa: ARG001
    """A spreadsheet of a country that writes 0,5: semicolons between the cells."""
    text = table_text(recording["odometry"], separator=";").replace(".", ",")
    return recording.with_file("odometry.csv", text.encode())


def no_header(recording, rng):  # noqa: ARG001
    text = table_text(recording["odometry"]).split("\n", 1)[1]
    return recording.with_file("odometry.csv", text.encode())


def other_names(recording, rng):
    names = [("left", "right"), ("vl", "vr"), ("v_l", "v_r"), ("left_speed", "right_speed")]
    left, right = names[rng.integers(len(names))]
    renamed = {"v_left": left, "v_right": right}
    table = recording["odometry"]
    return recording.with_table("odometry", {renamed.get(n, n): c for n, c in table.items()})


def cut_last_row(recording, rng):
    """The recorder was killed: the last row ends after its first or second cell."""
    name = rng.choice([name for name in ("odometry", "pose") if name in recording])
    lines = table_text(recording[name]).rstrip("\n").split("\n")
    lines[-1] = ",".join(lines[-1].split(",")[: rng.integers(1, 3)])
    return recording.with_file(f"{name}.csv", "\n".join(lines).encode())


def empty_poses(recording, rng):  # noqa: ARG001
    header = ",".join(recording["pose"]) + "\n"
    return recording.with_file("pose.csv", header.encode())


def zeros_at_the_end(recording, rng):
    """A power cut: the file ends in a block of NUL bytes."""
    content = (recording.folder / "odometry.csv").read_bytes()
    return recording.with_file("odometry.csv", content + b"\0" * int(rng.integers(100, 4000)))


def never_moves(recording, rng):
    """The wrong bag: the robot stands all along, noise in every column."""
    table = recording["odometry"]
    result = recording.with_columns(
        "odometry",
        **{n: np.zeros(len(table["t"])) for n in ("v_left", "v_right")},
        gyro_z=rng.normal(0, 0.003, len(table["t"])),
    )
    count = len(recording["pose"]["t"])
    noise = {n: rng.normal(0, s, count) for n, s in (("x", 0.005), ("y", 0.005), ("yaw", 0.002))}
    return result.with_columns("pose", **noise)


def infinite(recording, rng):
    speed = recording["odometry"]["v_right"].copy()
    speed[rng.integers(1, len(speed) - 1)] = rng.choice([-math.inf, math.inf])
    return recording.with_columns("odometry", v_right=speed)


POSE = frozenset({"pose"})
# fmt: off
FAULTS = (
    Fault("cells_parted_by_semicolons", "refused", "Semicolons part the cells, commas decimals.",
          ("semicolon", "separator", "comma", "delimit", "column", ";"), semicolons),
    Fault("header_missing", "refused", "The first row is numbers, not names.",
          ("header", "column", "first row", "name"), no_header),
    Fault("columns_of_other_names", "refused", "v_left and v_right have other names.",
          ("v_left", "column", "name"), other_names),
    Fault("last_row_cut", "note", "The last row is incomplete.",
          ("last", "cut", "truncat", "incomplete", "cell", "field", "killed", "interrupt"),
          cut_last_row),
    Fault("poses_empty", "note", "pose.csv has a header and no rows.",
          ("empty", "no row", "no pose", "header"), empty_poses, POSE),
    Fault("zeros_at_the_end", "refused", "The file ends in NUL bytes.",
          ("nul", "binary", "zero", "power", "byte", "damaged", "corrupt"), zeros_at_the_end),
    Fault("robot_never_moves", "note", "The robot stands all along.",
          ("stand", "never move", "does not move", "stationary", "still", "no motion", "parked"),
          never_moves,
          frozenset({"good pose", "gyro"})),
    Fault("speed_infinite", "refused", "A speed is infinite.",
          ("inf", "finite", "number"), infinite),
)
# fmt: on
