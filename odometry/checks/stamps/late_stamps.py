"""What is said of late sensors, of clocks that run apart, and of speeds that are commands."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import TREADS, Mend, changed, in_turn, sooner
from odometry.checks.statistics.lag import Lag
from odometry.recording.run import Run

GRID_S = 0.02
CONSTANTS_S = (0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0, 1.5)
CLEARLY = 0.7  # share of the residual squares that the better explanation leaves of the other's


def followed(constant_s: float) -> Mend:
    """Tread speeds through a lag of first order: what a drive makes of its commands."""
    return in_turn(*(_slower(name, constant_s) for name in TREADS))


def _slower(name: str, constant_s: float) -> Mend:
    def mend(run: Run) -> Run:
        stamps_s = run.odometry.stamps_s
        return changed("odometry", name, lambda values: _filtered(stamps_s, values, constant_s))(
            run
        )

    return mend


def _filtered(stamps_s: FloatArray, values: FloatArray, constant_s: float) -> FloatArray:
    """Values (N,) that hold, through a lag of first order, at their stamps."""
    reach_s = 6 * constant_s
    grid_s = np.arange(stamps_s[0] - reach_s, stamps_s[-1] + GRID_S, GRID_S)
    rows = np.clip(np.searchsorted(stamps_s, grid_s, side="right") - 1, 0, None)
    kernel = np.exp(-np.arange(0.0, reach_s, GRID_S) / constant_s)
    slow = np.convolve(values[rows], kernel / kernel.sum())[: len(grid_s)]
    return np.asarray(np.interp(stamps_s, grid_s, slow))


def commands_or_stamps(evidence: Evidence, early_s: float) -> tuple[str, Mend]:
    """Which of both explains treads that are early by so much, and what undoes it.

    Returns
    -------
    words : str
        "commands", "stamps", or "either" where neither explains clearly more.
    mend : callable of Run to Run
    """
    stamps = sooner(TREADS, -early_s)
    lags = [followed(constant_s) for constant_s in CONSTANTS_S if constant_s < 4 * early_s]
    left_by_stamps = _left(evidence, stamps)
    left, commands = min(((_left(evidence, mend), mend) for mend in lags), key=lambda pair: pair[0])
    if left < CLEARLY * left_by_stamps:
        return "commands", commands
    if left_by_stamps < CLEARLY * left:
        return "stamps", stamps
    return "either", commands if left < left_by_stamps else stamps


def one_side_alone(evidence: Evidence, lag: Lag) -> str:
    """Words where one tread alone, late by twice as much, explains the turns clearly better."""
    left_by_both = _left(evidence, sooner(TREADS, lag.seconds))
    for name in TREADS:
        if _left(evidence, sooner((name,), 2 * lag.seconds)) < CLEARLY * left_by_both:
            return f"{name} alone explains the turns better with other stamps than both do"
    return ""


def _left(evidence: Evidence, mend: Mend) -> float:
    """Share of the turns that the treads do not explain."""
    mended = Evidence(mend(evidence.run), evidence.left_out_s)
    found = mended.gyroscope_by_treads or mended.pose_turn_by_treads
    return 1.0 if found is None else 1 - found.explained


NAMES = {"pose": "poses", "treads": "treads", "gyroscope": "gyroscope"}

EVEN = 1e-3  # of the period
SMOOTH = "; or its rate is smoothed (a low-pass filter)"
SMOOTH_TOO = ", or its rate is smoothed"
MADE_UP = "; or rows of odometry.csv were lost, and its stamps made up at an even pace"


def clocks_apart(evidence: Evidence, drifting: dict[tuple[str, str], Lag]) -> Finding:
    """The sensor that most of the pairs whose lag grows have in common."""
    counts = {name: sum(name in pair for pair in drifting) for name in NAMES}
    odd = max(counts, key=lambda name: counts[name])
    (late, early), lag = next((p, v) for p, v in drifting.items() if odd in p)
    mend = None
    if odd == "pose":
        mend = _with_clock(evidence, "pose", lag)
    elif evidence.gyroscope_file == "imu.csv" and {late, early} == {"treads", "gyroscope"}:
        opposite = Lag(-lag.seconds, lag.sigma_s, -lag.drift, 0.0, 0.0, lag.pieces, lag.together)
        mend = _with_clock(evidence, "imu", opposite)
    return Finding(
        "clocks_apart",
        Level.WARNING,
        f"the lag of {late} behind {early} grows by {1000 * lag.drift:+.2f} "
        f"+- {1000 * lag.drift_sigma:.2f} ms per second "
        f"({lag.drift * evidence.duration_s:+.2f} s over the recording)",
        f"Clocks run apart: that of the {NAMES[odd]} has a drift of {100 * lag.drift:+.2f} % "
        "against the other" + MADE_UP * (odd == "pose" and lag.drift > 0 and are_even(evidence)),
        "Stamp all files by one clock (log time, or clocks that are synchronised)",
        mend=mend,
    )


def are_even(evidence: Evidence) -> bool:
    """Whether all rows of odometry.csv are equally far apart, as no clock measures them."""
    return bool(np.ptp(np.diff(evidence.stamps_s)) < EVEN * evidence.period_s)


def _with_clock(evidence: Evidence, table: str, lag: Lag) -> Mend:
    """Stamps less the lag that they have at each time."""
    middle_s = float(evidence.stamps_s[[0, -1]].mean())

    def on_time(stamps_s: FloatArray) -> FloatArray:
        return np.asarray(stamps_s - lag.seconds - lag.drift * (stamps_s - middle_s))

    return changed(table, "t", on_time)


def pose_late(lag: Lag, other: str, *, gyroscope: bool = True) -> Finding:
    """Poses that are late, or early, against the gyroscope or the treads.

    Where there is a `gyroscope` that does not decide, the words say so.
    """
    word, opposite = _words(lag)
    begins, more = "Stamps", ""
    if other == "the treads":
        begins = "Either stamps"
        without = "by the gyroscope here" if gyroscope else "without a gyroscope"
        more = f"; or those of the treads are {opposite}: {without} this cannot be determined"
        if lag.seconds > 0:
            more += " (v_left and v_right may be commands, which the robot follows later)"
    elif lag.seconds < 0:
        more = "; or treads and gyroscope are both late by as much"
    return Finding(
        "pose_late",
        Level.WARNING,
        _seen("poses", lag, other),
        f"{begins} of poses are {word}: a delay of the sensor, its filter or its transport, or "
        f"stamps at arrival{more}",
        _remedy("poses", lag),
        mend=changed("pose", "t", lambda stamps_s: stamps_s - lag.seconds),
    )


def gyroscope_late(evidence: Evidence, lag: Lag) -> Finding:
    """A gyroscope that is late, or early, against poses and treads."""
    word, _ = _words(lag)
    mend = (
        changed("imu", "t", lambda stamps_s: stamps_s - lag.seconds)
        if evidence.gyroscope_file == "imu.csv"
        else sooner(("gyro_z",), lag.seconds)
    )
    return Finding(
        "gyroscope_late",
        Level.WARNING,
        _seen("gyroscope", lag, "pose and treads"),
        f"Stamps of gyroscope are {word}: a delay of the sensor, its filter or its transport, or "
        f"stamps at arrival{SMOOTH * (lag.seconds > 0)}",
        _remedy("gyroscope", lag),
        mend=mend,
    )


def treads_apart(evidence: Evidence, lag: Lag, other: str, *, decided: bool) -> Finding:
    """Treads that are late, or early: then they may be commands.

    Where poses have not decided it, the other sensor may be the one, and is named as well.
    """
    word, opposite = _words(lag)
    begins = "Stamps" if decided else "Either stamps"
    cause = (
        f"{begins} of treads are {word}: a delay of the sensor, its filter or its transport, or "
        "stamps at arrival"
    )
    undecided = (
        ""
        if decided
        else f"; or stamps of {other} are {opposite}{SMOOTH_TOO * (lag.seconds < 0)}: poses do not "
        "decide between these"
    )
    if lag.seconds > 0:
        smooth = f"{cause}; or the speeds are smoothed (a low-pass filter){undecided}"
        return _treads("treads_late", lag, other, smooth)
    kind, mend = commands_or_stamps(evidence, -lag.seconds)
    if kind == "stamps":
        delayed = "; or they are commands on which the robot acts so much later"
        delayed += "; or gyroscope and poses are both late by as much" if decided else ""
        return _treads("treads_late", lag, other, f"{cause}{delayed}{undecided}", mend)
    either = "; or their stamps are early: these cannot be distinguished"
    more = "" if kind == "commands" else either
    return _treads(
        "treads_are_commands",
        lag,
        other,
        f"{'' if decided else 'Either '}v_left and v_right are commands, which the robot follows "
        "later, or the robot itself turns "
        f"so much later than its wheels (soft terrain, tracks, a heavy load){more}{undecided}",
        mend,
    )


def _treads(name: str, lag: Lag, other: str, cause: str, mend: Mend | None = None) -> Finding:
    commands = name == "treads_are_commands"
    return Finding(
        name,
        Level.WARNING,
        _seen("treads", lag, other),
        cause,
        "Log the speeds that the wheels have; if these are they, it is the robot"
        if commands
        else _remedy("treads", lag),
        mend=mend or sooner(TREADS, lag.seconds),
    )


def _words(lag: Lag) -> tuple[str, str]:
    return ("late", "early") if lag.seconds > 0 else ("early", "late")


def _seen(sensor: str, lag: Lag, other: str) -> str:
    return (
        f"the yaw rate of {sensor} is {abs(lag.seconds):.3f} +- {lag.sigma_s:.3f} s "
        f"{_words(lag)[0]} against {other} (correlation {lag.correlation:.2f})"
    )


def _remedy(sensor: str, lag: Lag) -> str:
    return f"Subtract {lag.seconds:+.3f} s from the stamps of the {sensor}"
