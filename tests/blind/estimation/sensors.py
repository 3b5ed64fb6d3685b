"""Faults of encoders and gyroscope; poses are right, where there are any."""

import numpy as np

from tests.blind.estimation import poses
from tests.blind.estimation.case import DriveFault, acts, driven, during, span
from tests.blind.faults.fault import UnsuitableError

SIDES = ("v_left", "v_right")


def one_absurd(recording, rng):
    table = recording["odometry"]
    begin, _ = span(recording, rng, 1.0)
    row, side = np.searchsorted(table["t"], begin), SIDES[rng.integers(2)]
    value = np.where(np.arange(len(table["t"])) == row, 50.0, table[side])
    return acts(driven(recording, **{side: value}), begin, table["t"][row + 1])


def stick(length_s):
    def draw(recording, rng):
        """One encoder says zero while its tread turns."""
        side = SIDES[rng.integers(2)]
        for _ in range(50):
            begin, end = span(recording, rng, length_s, least_m=0.3 * length_s)
            table = recording["odometry"]
            held = during(table, begin, end)
            if np.abs(table[side][held]).mean() > 0.25:
                faulty = driven(recording, **{side: np.where(held, 0.0, table[side])})
                return acts(faulty, begin, end, reckons=True)
        raise UnsuitableError

    return draw


def hold_both(recording, rng):
    """Both encoders hold their last value for 3 s."""
    begin, end = span(recording, rng, 3.0, least_m=1.0)
    table = recording["odometry"]
    held = during(table, begin, end)
    row = np.flatnonzero(held)[0] - 1
    columns = {side: np.where(held, table[side][row], table[side]) for side in SIDES}
    return acts(driven(recording, **columns), begin, end, reckons=True)


def gap(recording, rng):
    begin, end = span(recording, rng, 6.0, least_m=2.0)
    faulty = recording.with_rows("odometry", ~during(recording["odometry"], begin, end))
    return acts(faulty, begin, end, reckons=True)


def swap(recording, rng):
    begin, end = span(recording, rng, rng.uniform(10, 20), least_m=3.0)
    table = recording["odometry"]
    held = during(table, begin, end)
    left, right = table["v_left"], table["v_right"]
    faulty = driven(
        recording, v_left=np.where(held, right, left), v_right=np.where(held, left, right)
    )
    return acts(faulty, begin, end, reckons=True)


def one_slips(recording, rng):
    """One tread reports 40 % more than the ground sees, for 10 s."""
    begin, end = span(recording, rng, 10.0, least_m=2.0)
    table, side = recording["odometry"], SIDES[rng.integers(2)]
    factor = np.where(during(table, begin, end), 1.4, 1.0)
    return acts(driven(recording, **{side: table[side] * factor}), begin, end, reckons=True)


def lost_messages(recording, rng):
    """15 % of the rows of odometry are read as zero."""
    table = recording["odometry"]
    there = rng.random(len(table["t"])) > 0.15
    columns = {side: table[side] * there for side in SIDES}
    return acts(driven(recording, **columns), table["t"][0], table["t"][-1])


def _gyro(recording, values, begin_s=None, end_s=None):
    t = recording["odometry"]["t"]
    return acts(driven(recording, gyro_z=values), begin_s or t[0], end_s or t[-1])


def bias(recording, rng):
    rates = recording["odometry"]["gyro_z"]
    return _gyro(recording, rates + rng.choice([-1, 1]) * rng.uniform(0.02, 0.05))


def drift(recording, rng):
    """The bias grows over the run to 0.05 rad/s."""
    table = recording["odometry"]
    share = (table["t"] - table["t"][0]) / np.ptp(table["t"])
    return _gyro(recording, table["gyro_z"] + rng.choice([-0.05, 0.05]) * share)


def bias_step(recording, rng):
    table = recording["odometry"]
    begin, _ = span(recording, rng, 10.0)
    step = rng.choice([-1, 1]) * rng.uniform(0.05, 0.1) * (table["t"] >= begin)
    return _gyro(recording, table["gyro_z"] + step, begin)


def spikes(recording, rng):
    rates = recording["odometry"]["gyro_z"].copy()
    rows = rng.choice(np.arange(20, len(rates) - 1), rng.integers(3, 15), replace=False)
    rates[rows] = rng.choice([-1, 1], len(rows)) * rng.uniform(5, 50, len(rows))
    t = recording["odometry"]["t"][np.sort(rows)]
    return _gyro(recording, rates, t[0], t[-1])


def silence(recording, rng):
    begin, end = span(recording, rng, rng.uniform(8, 20), least_m=2.0)
    table = recording["odometry"]
    rates = np.where(during(table, begin, end), np.nan, table["gyro_z"])
    return _gyro(recording, rates, begin, end)


def scale(recording, rng):
    return _gyro(recording, recording["odometry"]["gyro_z"] * rng.choice([0.95, 1.05]))


def hold_gyro(recording, rng):
    """The gyroscope holds one value for 10 s in which the robot turns."""
    table = recording["odometry"]
    for _ in range(50):
        begin, end = span(recording, rng, 10.0, least_m=2.0)
        held = during(table, begin, end)
        if np.ptp(table["gyro_z"][held]) > 0.3:
            value = table["gyro_z"][np.flatnonzero(held)[0]]
            return _gyro(recording, np.where(held, value, table["gyro_z"]), begin, end)
    raise UnsuitableError


def outage_and_stuck(recording, rng):
    """No poses for 20 s, and in the midst of it one encoder sticks for 4 s."""
    out = poses.outage(20.0)(recording, rng)
    table, side = recording["odometry"], SIDES[rng.integers(2)]
    held = during(table, out.begin_s + 8, out.begin_s + 12)
    faulty = driven(out.recording, **{side: np.where(held, 0.0, table[side])})
    return acts(faulty, out.begin_s, out.end_s, reference=out.reference, reckons=True)


def outage_and_silence(recording, rng):
    """No poses for 20 s, and no gyroscope either."""
    out = poses.outage(20.0)(recording, rng)
    table = recording["odometry"]
    rates = np.where(during(table, out.begin_s, out.end_s), np.nan, table["gyro_z"])
    faulty = driven(out.recording, gyro_z=rates)
    return acts(faulty, out.begin_s, out.end_s, reference=out.reference, reckons=True)


STUCK = "stuck|encoder|tread|slip|disagree"
GYRO = "gyro|spike|silen|bias"
FAULTS = (
    DriveFault(
        "one_50_m_s",
        "One sample of a tread is 50 m/s.",
        "spike|absurd|speed|tread|outlier",
        one_absurd,
        named=True,
    ),
    DriveFault("stuck_4s", "One encoder says zero for 4 s.", STUCK, stick(4.0), named=True),
    DriveFault("gap_6s", "Odometry is lost for 6 s.", "gap", gap, named=True),
    DriveFault(
        "gyro_bias",
        "The gyroscope has a bias of 0.02 to 0.05 rad/s.",
        GYRO,
        bias,
        named=True,
        flag=False,
    ),
    DriveFault("gyro_drift", "The bias grows to 0.05 rad/s.", GYRO, drift, named=True, flag=False),
    DriveFault(
        "gyro_spikes", "Some samples of the gyroscope are absurd.", GYRO, spikes, named=True
    ),
    DriveFault("gyro_silence", "The gyroscope is silent for 8 to 20 s.", GYRO, silence, named=True),
    DriveFault(
        "gyro_bias_step", "The bias steps by 0.05 to 0.1 rad/s.", GYRO, bias_step, flag=False
    ),
    DriveFault("gyro_scale", "The gyroscope's scale is 5 % off.", GYRO, scale, flag=False),
    DriveFault("gyro_held", "The gyroscope holds a value for 10 s.", f"{GYRO}|{STUCK}", hold_gyro),
    DriveFault("both_held", "Both encoders hold for 3 s.", f"gap|{STUCK}", hold_both, flag=False),
    DriveFault("swapped", "The treads are swapped for 10 to 20 s.", f"swap|{STUCK}", swap),
    DriveFault(
        "one_slips", "One tread slips by 40 % for 10 s.", f"ICR|{STUCK}", one_slips, flag=False
    ),
    DriveFault(
        "lost_messages",
        "15 % of the rows of odometry are zero.",
        f"gap|spike|{STUCK}",
        lost_messages,
        flag=False,
    ),
    DriveFault(
        "outage_and_stuck", "An encoder sticks in an outage.", f"outage|{STUCK}", outage_and_stuck
    ),
    DriveFault(
        "outage_and_silence",
        "Neither poses nor gyroscope for 20 s.",
        f"outage|{GYRO}",
        outage_and_silence,
    ),
)
