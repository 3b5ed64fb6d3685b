"""Slip of the treads on the terrain: by speed, acceleration, torque, side, wheel angle, place."""
# ruff: noqa: ARG001 - all have one face, and few need all of it

import numpy as np

from tests.blind.hidden.courses import Patches, bursts, moment, rates_of, sign
from tests.blind.hidden.kind import Hidden, Kind


def slip_by_speed(rng, scene):
    """Each tread slips the more, the faster it runs."""
    share = rng.uniform(0.05, 0.25) / scene.speed_m_s

    def hide(rng, clock):
        return Hidden({"share_s_m": share}, treads=lambda v: v * (1 - share * np.abs(v)))

    return hide


def slip_by_acceleration(rng, scene):
    """Each tread lags behind its own acceleration by 0.05 to 0.25 s of it."""
    share_s = rng.uniform(0.05, 0.25)

    def hide(rng, clock):
        return Hidden(
            {"share_s": share_s}, treads=lambda v: v - share_s * rates_of(v, clock.step_s)
        )

    return hide


def slip_backward(rng, scene):
    """A tread grips less backward than forward, as lugs of one direction do."""
    kept = rng.uniform(0.75, 0.95)

    def hide(rng, clock):
        return Hidden({"kept": kept}, treads=lambda v: np.where(v < 0, kept * v, v))

    return hide


def slip_by_turning(rng, scene):
    """The torque of turning makes both treads slip, by the square of their difference."""
    share = rng.uniform(0.2, 0.8) / scene.speed_m_s**2

    def hide(rng, clock):
        def treads(asked):
            half = (asked[:, 1] - asked[:, 0]) / 2
            lost = half * np.clip(share * half**2, 0.0, 0.5)
            return asked + np.column_stack([lost, -lost])

        return Hidden({"share_s2_m2": share}, treads=treads)

    return hide


def one_turn_slips(rng, scene):
    """Left turns lose yaw rate, right turns do not (a twisted frame lifts one corner)."""
    kept, side = rng.uniform(0.7, 0.92), sign(rng)

    def hide(rng, clock):
        def twist(values, treads):
            factor = np.where(side * values[:, 2] > 0, kept, 1.0)
            return values * np.column_stack([np.ones((len(values), 2)), factor])

        return Hidden({"kept": kept, "side": side}, twist=twist)

    return hide


def loose_track(rng, scene):
    """A loose track skips teeth: each time the torque is high it jumps back by 3 to 8 cm."""
    side, tooth_m = int(rng.integers(2)), rng.uniform(0.03, 0.08)
    least_m_s2 = rng.uniform(0.2, 0.5)

    def hide(rng, clock):
        def treads(asked):
            hard = np.abs(rates_of(asked[:, side], clock.step_s)) > least_m_s2
            result, row = asked.copy(), 0
            pause, width = round(0.8 / clock.step_s), round(0.08 / clock.step_s)
            while row < len(hard):
                if hard[row]:
                    back = np.sign(asked[row, side]) * tooth_m / 0.08
                    result[row : row + width, side] -= back
                    row += pause
                row += 1
            return result

        return Hidden({"side": side, "tooth_m": tooth_m, "least_m_s2": least_m_s2}, treads=treads)

    return hide


def stick_and_slip(rng, scene):
    """One tread's speed ripples with the angle of its bent sprocket."""
    side, depth = int(rng.integers(2)), rng.uniform(0.15, 0.5)
    teeth = int(rng.integers(1, 4))

    def hide(rng, clock):
        phase = rng.uniform(0, 2 * np.pi)

        def treads(asked):
            angle = np.cumsum(asked[:, side]) * clock.step_s * teeth / scene.body.wheel_radius
            ripple = 1 + depth * np.sin(angle + phase)
            return asked * np.where(np.arange(2) == side, ripple[:, None], 1.0)

        return Hidden({"side": side, "depth": depth, "a_turn": teeth}, treads=treads)

    return hide


def side_slip_by_force(rng, scene):
    """The tail slides outward by v omega^2 (no linear law of force)."""
    share = sign(rng) * rng.uniform(0.05, 0.3)

    def hide(rng, clock):
        def twist(values, treads):
            slide = share * values[:, 0] * values[:, 2] ** 2
            return values + np.column_stack([0 * slide, slide, 0 * slide])

        return Hidden({"share_s_rad": share}, twist=twist)

    return hide


def grip_lost(rng, scene):
    """From some moment on, each run's own, all speeds and turns fall short (k and m of Salvi)."""
    k, m = rng.uniform(0.7, 0.97), rng.uniform(0.55, 0.95)

    def hide(rng, clock):
        at_s = moment(rng, clock)
        factors = np.where((clock.times_s >= at_s)[:, None], [k, m, m], 1.0)
        return Hidden({"k": k, "m": m, "moment_s": at_s}, twist=lambda twist, _: twist * factors)

    return hide


def lost_tyre(rng, scene):
    """At some moment one side loses 4 to 12 % of its radius."""
    side, loss = int(rng.integers(2)), rng.uniform(0.04, 0.12)

    def hide(rng, clock):
        at_s = moment(rng, clock)
        gone = (clock.times_s >= at_s)[:, None] & (np.arange(2) == side)
        truth = {"side": side, "loss": loss, "moment_s": at_s}
        return Hidden(truth, treads=lambda v: v * np.where(gone, 1 - loss, 1.0))

    return hide


def one_side_deflates(rng, scene):
    """A puncture: one side loses radius slowly over the run, each run by its own."""
    side = int(rng.integers(2))

    def hide(rng, clock):
        loss = rng.uniform(0.03, 0.09)
        factor = 1 - loss * clock.share[:, None] * (np.arange(2) == side)
        return Hidden({"side": side, "loss": loss}, treads=lambda v: v * factor)

    return hide


def slippery_patches(rng, scene):
    """Patches of some metres, on no label, where turns are wider and treads slip."""
    patches = Patches(rng, rng.uniform(3.0, 8.0), rng.uniform(0.15, 0.4))
    kept = rng.uniform(0.5, 0.9, 2)

    def hide(rng, clock):
        def at_place(row, pose, twist):
            here = patches.at(*pose[:2])
            turned = 1 - here * (1 - kept[1])
            return twist[0] * (1 - here * (1 - kept[0])), twist[1] * turned, twist[2] * turned

        return Hidden({"kept": kept.tolist()}, at_place=at_place)

    return hide


def puddles(rng, scene):
    """One tread runs through ruts of water for 1 to 4 s at a time; either side, by chance."""
    kept = rng.uniform(0.5, 0.85)

    def hide(rng, clock):
        mask, events = bursts(rng, clock, (1.0, 4.0), (4.0, 18.0))
        sides = np.zeros((len(mask), 2), dtype=bool)
        for begin, end in events:
            rows = (clock.times_s >= begin) & (clock.times_s < end)
            sides[rows, rng.integers(2)] = True
        factor = np.where(sides & mask[:, None], kept, 1.0)
        return Hidden({"kept": kept, "events": events}, treads=lambda v: v * factor)

    return hide


def clogging_mud(rng, scene):
    """Mud fills the treads: turns become wider and wider over the run."""
    most = rng.uniform(0.15, 0.5)

    def hide(rng, clock):
        wider = 1 + most * rng.uniform(0.7, 1.3) * clock.share

        def icrs(values, treads):
            return {**values, **{key: wider * values[key] for key in ("y_left", "y_right")}}

        return Hidden({"wider": float(wider[-1])}, icrs=icrs)

    return hide


def other_terrain(rng, scene):
    """All of a run is on a terrain that the calibration never saw, and nobody labels it."""
    wider, shift = rng.choice([0.8, 1.3, 1.5]), scene.body.length * rng.uniform(-0.15, 0.15)
    grip = rng.uniform(0.85, 0.99, 2)

    def hide(rng, clock):
        def icrs(values, treads):
            return {
                "y_left": wider * values["y_left"],
                "y_right": wider * values["y_right"],
                "x_icr": values["x_icr"] + shift,
                "alpha_left": grip[0] * values["alpha_left"],
                "alpha_right": grip[1] * values["alpha_right"],
            }

        truth = {"wider": float(wider), "x_shift": shift, "grip": grip.tolist()}
        return Hidden(truth, icrs=icrs)

    return hide


IN_BURSTS = ("wheel size in_bursts", "traction in_bursts", "tread slip in_bursts")
SLIPS = {
    "slip_by_speed": Kind(slip_by_speed, (("tread slip",),)),
    "slip_by_acceleration": Kind(
        slip_by_acceleration, (("tread slip",),), acceptable=("slow drive",)
    ),
    "slip_backward": Kind(slip_backward, (("tread slip",),)),
    "slip_by_turning": Kind(slip_by_turning, acceptable=("tread slip", "turn radius")),
    "one_turn_slips": Kind(one_turn_slips),
    "loose_track": Kind(loose_track, acceptable=("tread slip", *IN_BURSTS)),
    "stick_and_slip": Kind(stick_and_slip),
    "side_slip_by_force": Kind(side_slip_by_force, acceptable=("inertia",)),
    "grip_lost": Kind(grip_lost, (("traction",),), course="from_a_moment"),
    "lost_tyre": Kind(lost_tyre, (("wheel size",),), course="from_a_moment"),
    "one_side_deflates": Kind(one_side_deflates, (("wheel size",),), course="gradual"),
    "slippery_patches": Kind(
        slippery_patches, (("unknown", "terrain"),), acceptable=IN_BURSTS, course="in_bursts"
    ),
    "puddles": Kind(puddles, acceptable=IN_BURSTS, course="in_bursts"),
    "clogging_mud": Kind(
        clogging_mud,
        acceptable=("traction gradual", "turn radius gradual", "terrain gradual"),
        course="gradual",
    ),
    "other_terrain": Kind(other_terrain, (("terrain",),)),
}
