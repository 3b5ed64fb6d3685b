"""The robot moves while its treads do not, or the other way round: time is put in.

All that was recorded after a moment comes later by the length of what is put in, and where the
robot was moved in between, its later poses are those of the new place.
"""

import numpy as np

from tests.blind.estimation.case import DriveFault, acts, span
from tests.blind.faults.fault import UnsuitableError

NOISE_M, NOISE_RAD, GYRO_NOISE = 0.005, 0.002, 0.005


def slip_on_the_spot(recording, rng):
    """The treads turn at 0.3 to 1 m/s for 5 s, and the robot stands."""
    speed = rng.choice([-1, 1]) * rng.uniform(0.3, 1.0)
    return _put_in(recording, rng, 5.0, (0.0, 0.0, 0.0), (speed, speed))


def spin_on_the_spot(recording, rng):
    """The treads turn against each other for 5 s, and the robot stands."""
    speed = rng.choice([-1, 1]) * rng.uniform(0.3, 0.8)
    return _put_in(recording, rng, 5.0, (0.0, 0.0, 0.0), (speed, -speed))


def carried(recording, rng):
    """Lifted, turned and set down 3 m away in 8 s."""
    way, turn = rng.uniform(-np.pi, np.pi), rng.choice([-1, 1]) * rng.uniform(0.5, 2.0)
    return _put_in(recording, rng, 8.0, (3 * np.cos(way), 3 * np.sin(way), turn), (0.0, 0.0))


def towed(recording, rng):
    """Dragged forward by 5 m in 10 s; the treads stand still."""
    return _put_in(recording, rng, 10.0, (5.0, 0.0, 0.0), (0.0, 0.0))


def slid_unseen(recording, rng):
    """Slides 1.5 m downhill in 6 s, treads still, while no poses come."""
    way = rng.uniform(-np.pi, np.pi)
    case = _put_in(recording, rng, 6.0, (1.5 * np.cos(way), 1.5 * np.sin(way), 0.0), (0.0, 0.0))
    pose = case.recording["pose"]
    seen = (pose["t"] < case.begin_s - 1) | (pose["t"] > case.end_s + 1)
    faulty = case.recording.with_rows("pose", seen)
    reference = case.reference
    return acts(faulty, case.begin_s, case.end_s, reference=reference, size_m=1.5, reckons=True)


def _put_in(recording, rng, length_s, motion, treads):
    """Put in a motion (x, y, yaw seen from the robot) while the treads say `treads`."""
    moment = _still_moment(recording, rng)
    tables = {}
    for name, table in recording.tables.items():
        if name in ("pose", "truth"):
            tables[name] = _poses_put_in(table, moment, length_s, motion, rng, noisy=name == "pose")
        elif name == "odometry":
            tables[name] = _odometry_put_in(table, (moment, length_s), motion[2], treads, rng)
        else:
            raise UnsuitableError
    for name, table in tables.items():
        recording = recording.with_table(name, table)
    return acts(recording, moment, moment + length_s, size_m=0.0, reckons=True)


def _still_moment(recording, rng):
    """A stamp at which the treads are as slow as they get, so that nothing breaks there."""
    table = recording["odometry"]
    begin, end = span(recording, rng, 0.3 * np.ptp(table["t"]))
    rows = np.flatnonzero((table["t"] > begin) & (table["t"] < end))
    fastest = np.maximum(np.abs(table["v_left"]), np.abs(table["v_right"]))[rows]
    return table["t"][rows[np.argmin(fastest)]]


def _between(table, moment, length_s):
    """Row before the moment, and stamps of the rows to put in."""
    row = int(np.searchsorted(table["t"], moment, side="right")) - 1
    period = float(np.median(np.diff(table["t"])))
    return max(row, 0), moment + np.arange(period / 2, length_s, period)


def _later(table, moment, length_s):
    return np.where(table["t"] > moment, table["t"] + length_s, table["t"])


def _odometry_put_in(table, when, turn, treads, rng):
    moment, length_s = when
    row, stamps = _between(table, moment, length_s)
    put = {name: np.repeat(column[row], len(stamps)) for name, column in table.items()}
    put |= {"t": stamps, "v_left": np.full(len(stamps), treads[0])}
    put |= {"v_right": np.full(len(stamps), treads[1])}
    if "gyro_z" in table:
        put["gyro_z"] = turn / length_s + rng.normal(0, GYRO_NOISE, len(stamps))
    after = {**table, "t": _later(table, moment, length_s)}
    return {name: np.insert(after[name], row + 1, put[name]) for name in table}


def _poses_put_in(table, moment, length_s, motion, rng, *, noisy):
    row, stamps = _between(table, moment, length_s)
    x, y, yaw = (table[name][row] for name in ("x", "y", "yaw"))
    share = (stamps - moment) / length_s
    cosine, sine = np.cos(yaw), np.sin(yaw)
    dx, dy = cosine * motion[0] - sine * motion[1], sine * motion[0] + cosine * motion[1]
    put = {name: np.repeat(column[row], len(stamps)) for name, column in table.items()}
    put |= {"t": stamps, "x": x + share * dx, "y": y + share * dy, "yaw": yaw + share * motion[2]}
    if noisy:
        for name, sigma in (("x", NOISE_M), ("y", NOISE_M), ("yaw", NOISE_RAD)):
            put[name] = put[name] + rng.normal(0, sigma, len(stamps))
    after, turn = table["t"] > moment, motion[2]
    east, north = table["x"] - x, table["y"] - y
    moved = {
        "t": _later(table, moment, length_s),
        "x": x + dx + np.cos(turn) * east - np.sin(turn) * north,
        "y": y + dy + np.sin(turn) * east + np.cos(turn) * north,
        "yaw": table["yaw"] + turn,
    }
    later = {n: np.where(after, moved[n], table[n]) if n in moved else table[n] for n in table}
    return {name: np.insert(later[name], row + 1, put[name]) for name in table}


SLIP = "slip|stuck|stand|tread|disagree|carried|moved|jump|re-?init"
FAULTS = (
    DriveFault(
        "slip_on_the_spot", "The treads turn and the robot stands, 5 s.", SLIP, slip_on_the_spot
    ),
    DriveFault(
        "spin_on_the_spot",
        "The treads turn against each other and the robot stands, 5 s.",
        SLIP,
        spin_on_the_spot,
    ),
    DriveFault("carried", "Carried and turned by 3 m, treads still.", SLIP, carried),
    DriveFault("towed", "Dragged forward by 5 m, treads still.", SLIP, towed),
    DriveFault(
        "slid_unseen", "Slid by 1.5 m in an outage, treads still.", f"outage|{SLIP}", slid_unseen
    ),
)
