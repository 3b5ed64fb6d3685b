"""What field work does to a robot: rain, snow, heat, new firmware, a bent part, a moved mast."""
# ruff: noqa: ARG001, ARG005 - all have one face, and few need all of it

import math

import numpy as np

from tests.blind.hidden.courses import lagged, moment, sign
from tests.blind.hidden.kind import Hidden, Kind
from tests.blind.hidden.mixed import mix


def moved_mast(rng, scene):
    """The reference was put back 0.1 to 0.5 m from its old place."""
    where, far_m = rng.uniform(-math.pi, math.pi), rng.uniform(0.1, 0.5)

    def hide(rng, clock):
        def reference(times_s, poses):
            place = far_m * np.exp(1j * (where + poses[:, 2]))
            moved = np.column_stack([place.real, place.imag, np.zeros(len(poses))])
            return times_s, poses + moved

        return Hidden({"where_rad": where, "far_m": far_m}, reference=reference)

    return hide


def declination(rng, scene):
    """The yaw of the reference is that of a compass whose declination was forgotten."""
    off = sign(rng) * np.deg2rad(rng.uniform(2.0, 15.0))

    def hide(rng, clock):
        return Hidden(
            {"off_rad": off},
            reference=lambda times_s, poses: (times_s, poses + np.array([0.0, 0.0, off])),
        )

    return hide


def rain_begins(rng, scene):
    """From some moment, within 0 to 3 s, the robot goes 5 to 25 % and turns 10 to 40 % less."""
    less = np.array([rng.uniform(0.05, 0.25), *[rng.uniform(0.1, 0.4)] * 2])

    def hide(rng, clock):
        at_s, within_s = moment(rng, clock), rng.uniform(0.0, 3.0)
        wet = np.clip((clock.times_s - at_s) / (within_s + clock.step_s), 0.0, 1.0)[:, None]
        return Hidden(
            {"less": less.tolist(), "moment_s": at_s, "within_s": within_s},
            twist=lambda values, treads: values * (1 - less * wet),
        )

    return hide


def firmware_ramps(rng, scene):
    """New firmware of the drives smooths commands twice, over 0.08 to 0.25 s each."""
    constants_s = rng.uniform(0.08, 0.25, 2)

    def hide(rng, clock):
        def treads(asked):
            return lagged(lagged(asked, constants_s[0], clock.step_s), constants_s[1], clock.step_s)

        return Hidden({"constants_s": constants_s.tolist()}, treads=treads)

    return hide


def snow_wedge(rng, scene):
    """Snow gathers as the robot drives forward, brakes it, and is left behind as it backs up."""
    most, length_m = rng.uniform(0.1, 0.4), rng.uniform(0.5, 3.0)

    def hide(rng, clock):
        def treads(asked):
            result, pushed_m = np.array(asked), 0.0
            for row, forward_m_s in enumerate(asked.mean(axis=1)):
                result[row] *= 1 - most * (1 - math.exp(-pushed_m / length_m))
                if forward_m_s < -0.02:
                    pushed_m = 0.0
                pushed_m += max(float(result[row].mean()), 0.0) * clock.step_s
            return result

        return Hidden({"most": most, "length_m": length_m}, treads=treads)

    return hide


def bent_sprocket(rng, scene):
    """One tread swells and ebbs by 10 to 40 % with each 0.4 to 2 m that its sprocket rolls."""
    share, turn_m = rng.uniform(0.1, 0.4), rng.uniform(0.4, 2.0)
    side = np.arange(2) == rng.integers(2)

    def hide(rng, clock):
        phase = rng.uniform(-math.pi, math.pi)

        def treads(asked):
            rolled_m = np.cumsum(asked, axis=0) * clock.step_s
            ripple = share * np.sin(2 * math.pi * rolled_m / turn_m + phase)
            return asked * (1 + side * ripple)

        return Hidden({"share": share, "turn_m": turn_m}, treads=treads)

    return hide


def thermal_cutback(rng, scene):
    """From some moment hot drives allow 40 to 80 % of the speed."""
    most_m_s = rng.uniform(0.4, 0.8) * scene.speed_m_s

    def hide(rng, clock):
        at_s = moment(rng, clock)
        hot = (clock.times_s >= at_s)[:, None]
        return Hidden(
            {"most_m_s": most_m_s, "moment_s": at_s},
            treads=lambda asked: np.where(hot, np.clip(asked, -most_m_s, most_m_s), asked),
        )

    return hide


FIELDWORK = {
    "mast_and_declination": mix(
        Kind(moved_mast, (("sensor place",),), acceptable=("sideways",)),
        Kind(declination, (("sensor heading",),)),
    ),
    "rain_begins": Kind(rain_begins, (("traction",),), course="from_a_moment"),
    "firmware_ramps": Kind(
        firmware_ramps,
        (("slow drive",),),
        acceptable=("late commands",),
        without_gyroscope=("late stamps",),
    ),
    "snow_wedge": Kind(snow_wedge, acceptable=("tread slip",)),
    "bent_sprocket": Kind(bent_sprocket),
    "thermal_cutback": Kind(thermal_cutback, acceptable=("drive limits",)),
}
