"""One tread whose slow speeds read zero: it seems lost where the robot drives slowly."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.measured_turns import measured_turns
from odometry.checks.findings.finding import Finding, Level

MOSTLY = 0.75  # share of the windows of such times in which the tread is slow
LEAST = 0.01  # of the values that are not zero: the slowest that is read
# Of the ordinary fastest speed: where the slowest reading is between these, slower speeds are none.
BAND = (0.1, 0.6)
# Of the ordinary fastest speed. In 48 simulated drives three quarters of the windows were below
# 0.22 or 1.07 times the slowest reading where slow speeds read zero; of encoders that were lost
# they reached 0.26 and more, and 4 times the slowest reading.
SLOW, ABOUT = 0.22, 1.2


def slow_speeds_zero(
    evidence: Evidence, name: str, spans: list[tuple[float, float]], times: str
) -> Finding | None:
    """A tread that reads zero in spans of stamps, and moves slowly in all of them; else None.

    An encoder that is lost goes on to be lost where the robot drives fast.
    """
    side = ("v_left", "v_right").index(name)
    values = np.abs(evidence.speeds_m_s[:, side])
    moves_m_s = _moves_m_s(evidence, spans, side)
    if not values.any() or moves_m_s is None:
        return None
    least_m_s = float(np.quantile(values[values != 0], LEAST))
    reads_none = BAND[0] < least_m_s / evidence.fastest_m_s < BAND[1]
    slow_m_s = max(SLOW * evidence.fastest_m_s, ABOUT * least_m_s if reads_none else 0.0)
    speed_m_s = float(np.quantile(np.abs(moves_m_s), MOSTLY))
    if speed_m_s > slow_m_s:
        return None
    tread = name.removeprefix("v_")
    none = f": it reads none between 0 and {least_m_s:.2g} m/s" if reads_none else ""
    return Finding(
        "slow_speeds_zero",
        Level.WARNING,
        f"{name} reads zero {times} of run time, where gyroscope or poses say that this tread "
        f"moves by up to {speed_m_s:.2g} m/s in most of it, and the fastest are "
        f"{evidence.fastest_m_s:.2g} m/s",
        f"Slow speeds of the {tread} tread read zero (a dead band, a minimum reading, play of the "
        f"gear){none}; or its encoder was stuck or lost at these times, which were slow by chance",
        "Turn that wheel slowly by hand and look what it reads; leave these times out",
        tuple((evidence.run_time_s(b), evidence.run_time_s(e)) for b, e in spans),
    )


def _moves_m_s(
    evidence: Evidence, spans: list[tuple[float, float]], side: int
) -> FloatArray | None:
    """Speeds (K,) of one tread in spans, by the first sensor of turns that was read in them."""
    for measured in measured_turns(evidence):
        found = measured.speeds_m_s(evidence.fastest_m_s, spans, side)
        if found is not None and len(found):
            return found
    return None
