"""Kinds that misled an earlier version of the gap workflow."""

import numpy as np

from tests.blind.effects import slope_sliding
from tests.blind.formula import icr_twist, icrs_on_slope, martinez_attitude
from tests.blind.hidden.courses import bursts, delayed, sign
from tests.blind.hidden.kind import Hidden, Kind


def deadband(rng, scene):  # noqa: ARG001
    """Commands of less than 0.05 to 0.12 m/s move nothing."""
    least = rng.uniform(0.05, 0.12)

    def hide(rng, clock):  # noqa: ARG001
        return Hidden({"least_m_s": least}, treads=lambda v: np.where(np.abs(v) < least, 0.0, v))

    return hide


def deflation(rng, scene):  # noqa: ARG001
    """Both tyres lose 3 to 8 % of their radius over each run."""

    def hide(rng, clock):
        loss = rng.uniform(0.03, 0.08)
        return Hidden({"loss": loss}, treads=lambda v: v * (1 - loss * clock.share)[:, None])

    return hide


def late_commands(rng, scene):  # noqa: ARG001
    """The treads do 0.1 to 0.3 s later what is asked; the gyroscope shows it."""
    delay_s = round(rng.uniform(0.1, 0.3), 2)

    def hide(rng, clock):  # noqa: ARG001
        return Hidden({"delay_s": delay_s}, treads=lambda v: delayed(v, delay_s, clock.step_s))

    return hide


def fast_pose_clock(rng, scene):  # noqa: ARG001
    """The clock of the reference gains or loses 1 to 4 ms each second."""
    rate = sign(rng) * rng.uniform(0.001, 0.004)

    def hide(rng, clock):  # noqa: ARG001
        return Hidden({"rate": rate}, reference=lambda t, poses: (t * (1 + rate), poses))

    return hide


def outliers(rng, scene):  # noqa: ARG001
    """One pose in 20 to 100 is up to some metres off."""
    share, far_m = rng.uniform(0.01, 0.05), rng.uniform(0.3, 3.0)

    def hide(rng, clock):  # noqa: ARG001
        seed = int(rng.integers(2**32))

        def reference(times_s, poses):
            draw = np.random.default_rng(seed)
            off = (draw.uniform(size=len(poses)) < share)[:, None]
            jumps = np.zeros_like(poses)
            jumps[:, :2] = far_m * draw.uniform(-1, 1, (len(poses), 2))
            return times_s, poses + off * jumps

        return Hidden({"share": share, "far_m": far_m}, reference=reference)

    return hide


def slip_bursts(rng, scene):  # noqa: ARG001
    """Both treads lose grip for 0.5 to 3 s, now and then."""
    kept = rng.uniform(0.4, 0.85)

    def hide(rng, clock):
        mask, events = bursts(rng, clock, (0.5, 3.0), (4.0, 20.0))
        factor = np.where(mask, kept, 1.0)[:, None]
        return Hidden({"kept": kept, "events": events}, treads=lambda v: v * factor)

    return hide


def changed_terrain(rng, scene):
    """One of two labelled terrains has become wet or frozen since the calibration."""
    name = str(rng.choice(list(scene.icrs)))
    wider, shift = rng.uniform(1.1, 1.6), scene.body.length * rng.uniform(-0.1, 0.1)
    grip = rng.uniform(0.85, 0.99, 2)

    def hide(rng, clock):  # noqa: ARG001
        def icrs(values, treads):  # noqa: ARG001
            on_it = _is_on(scene.icrs[name], values)
            return {
                "y_left": np.where(on_it, wider, 1.0) * values["y_left"],
                "y_right": np.where(on_it, wider, 1.0) * values["y_right"],
                "x_icr": values["x_icr"] + np.where(on_it, shift, 0.0),
                "alpha_left": np.where(on_it, grip[0], 1.0) * values["alpha_left"],
                "alpha_right": np.where(on_it, grip[1], 1.0) * values["alpha_right"],
            }

        return Hidden(
            {"terrain": name, "wider": wider, "x_shift": shift, "grip": grip.tolist()}, icrs=icrs
        )

    return hide


def slope_and_wheels(rng, scene):
    """Sliding on slopes, and tyres of another size by 3.6 %."""
    slides = rng.uniform(0.2, 1.0)
    p = slope_sliding(rng, scene.body, scene.base)
    p["v_max"] = max(p["v_max"], 1.05 * scene.speed_m_s)
    p |= {key: slides * p[key] for key in ("lambda_1", "lambda_2")}
    scale = 1.0 + np.array([[0.036, 0.0], [0.0, 0.036], [0.036, 0.036], [-0.036, 0.036]])
    scales = scale[rng.integers(4)] if rng.uniform() < 0.5 else 2.0 - scale[rng.integers(4)]

    def hide(rng, clock):  # noqa: ARG001
        def at_place(row, pose, twist):  # noqa: ARG001
            return sliding(scene.base, p, pose, twist)

        truth = {"wheels": scales.tolist(), "slope": p}
        return Hidden(truth, treads=lambda v: v * scales, at_place=at_place)

    return hide


def sliding(base, p, pose, twist):
    """Twist with the ICRs on the slope, of the same tread speeds: v = v_x - y omega of each."""
    v_x, _, omega = twist
    treads = v_x - base.y_left * omega, v_x - base.y_right * omega
    places = (base.y_left, base.y_right, base.x_icr)
    return icr_twist(*treads, *icrs_on_slope(*treads, places, martinez_attitude(*pose[3:]), p))


def _is_on(icrs, values):
    return np.isclose(values["y_left"], icrs.y_left, rtol=0, atol=1e-12)


SEEN = {
    "deadband": Kind(deadband, (("drive limits",),), style="crawl"),
    "deflation": Kind(
        deflation,
        (("wheel size",),),
        acceptable=("traction gradual", "tread slip gradual"),
        course="gradual",
    ),
    "late_commands": Kind(late_commands, (("late commands",),), gyroscope="always"),
    "fast_pose_clock": Kind(
        fast_pose_clock, (("reference", "late stamps gradual"),), course="gradual"
    ),
    "outliers": Kind(outliers, (("reference",),)),
    "slip_bursts": Kind(
        slip_bursts,
        (("traction", "tread slip"),),
        acceptable=("wheel size in_bursts", "terrain in_bursts"),
        course="in_bursts",
    ),
    "changed_terrain": Kind(changed_terrain, (("terrain",),), labels=2),
    "slope_and_wheels": Kind(slope_and_wheels, (("slope",), ("wheel size",)), sloped=True),
}
