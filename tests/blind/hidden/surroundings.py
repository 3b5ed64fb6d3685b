"""Forces from outside and loads aboard: wind, rope, trailer, payload, bumps, slopes."""
# ruff: noqa: ARG001 - all have one face, and few need all of it

import math

import numpy as np

from tests.blind.hidden.courses import Patches, lagged, moment, sign, wander
from tests.blind.hidden.kind import Hidden, Kind


def wind_gusts(rng, scene):
    """Gusts push the robot over slick terrain, from one side of the world, each run its own."""
    speed = rng.uniform(0.03, 0.12)

    def hide(rng, clock):
        direction = rng.uniform(-math.pi, math.pi)
        gust = speed * np.clip(wander(rng, clock, rng.uniform(1.5, 4.0)), 0.0, None)
        pushes = gust.tolist()

        def at_place(row, pose, twist):
            return carried(pose[2], twist, pushes[row], direction)

        return Hidden({"speed_m_s": speed, "direction_rad": direction}, at_place=at_place)

    return hide


def head_wind(rng, scene):
    """Upwind the robot is slower, downwind faster: a share of its speed by its heading."""
    share = rng.uniform(0.05, 0.2)

    def hide(rng, clock):
        direction = rng.uniform(-math.pi, math.pi)

        def at_place(row, pose, twist):
            factor = 1 - share * math.cos(pose[2] - direction)
            return twist[0] * factor, twist[1], twist[2]

        return Hidden({"share": share, "direction_rad": direction}, at_place=at_place)

    return hide


def tow_rope(rng, scene):
    """A rope to an anchor near the start brakes what leads away from it, once it is taut."""
    length_m, kept = rng.uniform(2.0, 8.0), rng.uniform(0.4, 0.85)

    def hide(rng, clock):
        anchor = []

        def at_place(row, pose, twist):
            if not anchor:
                anchor.append(complex(*pose[:2]))
            away = complex(*pose[:2]) - anchor[0]
            if abs(away) < length_m:
                return twist
            outward = away / abs(away) * complex(math.cos(pose[2]), -math.sin(pose[2]))
            velocity = complex(twist[0], twist[1])
            along = (velocity * outward.conjugate()).real
            if along > 0:
                velocity -= (1 - kept) * along * outward
            return velocity.real, velocity.imag, twist[2]

        return Hidden({"length_m": length_m, "kept": kept}, at_place=at_place)

    return hide


def conveyor(rng, scene):
    """Some areas of the floor move (belts, ice floes, running water)."""
    areas = Patches(rng, rng.uniform(4.0, 10.0), rng.uniform(0.15, 0.4))
    speed, direction = rng.uniform(0.05, 0.2), rng.uniform(-math.pi, math.pi)

    def hide(rng, clock):
        def at_place(row, pose, twist):
            return carried(pose[2], twist, speed * areas.at(*pose[:2]), direction)

        return Hidden({"speed_m_s": speed, "direction_rad": direction}, at_place=at_place)

    return hide


def dragging_caster(rng, scene):
    """A caster flips after each reversal and turns the robot while it does, over 0.4 m."""
    turn = sign(rng) * rng.uniform(0.4, 1.2)

    def hide(rng, clock):
        def twist(values, treads):
            left_m, last, extra = 0.0, 1.0, np.zeros(len(values))
            for row, speed in enumerate(values[:, 0]):
                if abs(speed) > 0.02 and np.sign(speed) != last:
                    last, left_m = np.sign(speed), 0.4
                if left_m > 0:
                    extra[row] = turn * abs(speed) * math.sin(math.pi * left_m / 0.4)
                    left_m -= abs(speed) * clock.step_s
            return values + np.column_stack([np.zeros((len(values), 2)), extra])

        return Hidden({"turn_rad_m": turn}, twist=twist)

    return hide


def shifting_payload(rng, scene):
    """A load slides to the outside of turns, within 1 to 3 s, and takes the ICRs with it."""
    most, constant_s = rng.uniform(0.1, 0.4), rng.uniform(1.0, 3.0)

    def hide(rng, clock):
        def icrs(values, treads):
            width = values["y_left"] - values["y_right"]
            omega = (treads[:, 1] - treads[:, 0]) / width
            force = np.clip(treads.mean(axis=1) * omega, -0.6, 0.6)
            shift = -most * scene.body.track_width * lagged(force, constant_s, clock.step_s) / 0.6
            ahead = values["x_icr"] + 0.5 * np.abs(shift)
            sides = {key: values[key] + shift for key in ("y_left", "y_right")}
            return {**values, **sides, "x_icr": ahead}

        return Hidden({"most": most, "constant_s": constant_s}, icrs=icrs)

    return hide


def put_down_load(rng, scene):
    """At some moment a load comes off the back: x_icr and the width change."""
    ahead = sign(rng) * scene.body.length * rng.uniform(0.06, 0.2)
    wider = rng.uniform(0.8, 0.95)

    def hide(rng, clock):
        at_s = moment(rng, clock)
        gone = clock.times_s >= at_s

        def icrs(values, treads):
            factor = np.where(gone, wider, 1.0)
            sides = {key: factor * values[key] for key in ("y_left", "y_right")}
            return {**values, **sides, "x_icr": values["x_icr"] + np.where(gone, ahead, 0.0)}

        truth = {"ahead_m": ahead, "wider": wider, "moment_s": at_s}
        return Hidden(truth, icrs=icrs)

    return hide


def trailer(rng, scene):
    """A trailer on a hitch resists turning until it has come round, with a lag by distance."""
    reach_m, share = rng.uniform(0.6, 1.5), rng.uniform(0.08, 0.3)

    def hide(rng, clock):
        def twist(values, treads):
            angle, extra = 0.0, np.zeros(len(values))
            for row, (speed, _, omega) in enumerate(values.tolist()):
                angle += clock.step_s * (omega - max(speed, 0.0) / reach_m * math.sin(angle))
                angle = min(max(angle, -1.2), 1.2)
                extra[row] = -share * abs(speed) / reach_m * math.sin(angle)
            return values + np.column_stack([np.zeros((len(values), 2)), extra])

        return Hidden({"reach_m": reach_m, "share": share}, twist=twist)

    return hide


def bumps(rng, scene):
    """Something knocks the robot round by 3 to 15 degrees within 0.3 s, a few times."""

    def hide(rng, clock):
        moments = rng.uniform(5.0, clock.duration_s - 5.0, rng.integers(5, 12))
        turns = np.deg2rad(rng.uniform(3.0, 15.0, len(moments))) * rng.choice([-1, 1], len(moments))
        extra = np.zeros(len(clock.times_s))
        for at_s, turn in zip(moments, turns, strict=True):
            extra[(clock.times_s >= at_s) & (clock.times_s < at_s + 0.3)] += turn / 0.3

        def twist(values, treads):
            return values + np.column_stack([np.zeros((len(values), 2)), extra])

        return Hidden({"moments_s": sorted(moments.tolist())}, twist=twist)

    return hide


def downhill_creep(rng, scene):
    """On a slope the robot creeps straight downhill while its treads run."""
    share = rng.uniform(0.2, 1.2)

    def hide(rng, clock):
        def at_place(row, pose, twist):
            roll, pitch = pose[3:]
            moving = abs(twist[0]) + 0.3 * abs(twist[2])
            creep = share * moving
            down = (math.sin(pitch), -math.cos(pitch) * math.sin(roll))
            return twist[0] + creep * down[0], twist[1] + creep * down[1], twist[2]

        return Hidden({"share": share}, at_place=at_place)

    return hide


def uphill_slip(rng, scene):
    """Uphill the treads slip, downhill they overrun: a share of speed by the pitch."""
    share = rng.uniform(0.5, 2.0)

    def hide(rng, clock):
        def at_place(row, pose, twist):
            ahead_up = -math.sin(pose[4]) * (1 if twist[0] > 0 else -1)
            return twist[0] * (1 - share * ahead_up), twist[1], twist[2]

        return Hidden({"share": share}, at_place=at_place)

    return hide


def magnetic_floor(rng, scene):
    """Magnetic wheels on a plate: turns are slower along one axis of the world, as by rails."""
    share, axis = rng.uniform(0.1, 0.4), rng.uniform(0, math.pi)

    def hide(rng, clock):
        def at_place(row, pose, twist):
            factor = 1 - share * math.cos(pose[2] - axis) ** 2
            return twist[0], twist[1] * factor, twist[2] * factor

        return Hidden({"share": share, "axis_rad": axis}, at_place=at_place)

    return hide


def carried(yaw, twist, speed, direction):
    """A twist with a velocity over the world added to it."""
    angle = direction - yaw
    return twist[0] + speed * math.cos(angle), twist[1] + speed * math.sin(angle), twist[2]


SURROUNDINGS = {
    "wind_gusts": Kind(wind_gusts, acceptable=("reference",)),
    "head_wind": Kind(head_wind),
    "tow_rope": Kind(tow_rope),
    "conveyor": Kind(conveyor, acceptable=("reference",)),
    "dragging_caster": Kind(dragging_caster),
    "shifting_payload": Kind(shifting_payload, acceptable=("inertia",)),
    "put_down_load": Kind(
        put_down_load,
        acceptable=("sideways from_a_moment", "terrain from_a_moment", "traction from_a_moment"),
        course="from_a_moment",
    ),
    "trailer": Kind(trailer),
    "bumps": Kind(bumps, without_gyroscope=("reference",)),
    "downhill_creep": Kind(downhill_creep, (("slope", "unknown"),), sloped=True),
    "uphill_slip": Kind(uphill_slip, (("slope", "unknown"),), sloped=True),
    "magnetic_floor": Kind(magnetic_floor),
}
