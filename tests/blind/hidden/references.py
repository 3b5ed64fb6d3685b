"""Faults of the reference: antennas, multipath, filters, maps, clocks, compasses."""
# ruff: noqa: ARG001 - all have one face, and few need all of it

import math

import numpy as np

from tests.blind.hidden.courses import Patches, bursts, sign
from tests.blind.hidden.kind import Hidden, Kind


def multipath(rng, scene):
    """Near buildings, at the same places each time, positions are 0.2 to 1 m off."""
    areas = Patches(rng, rng.uniform(4.0, 10.0), rng.uniform(0.1, 0.3))
    off = rng.uniform(0.2, 1.0) * np.exp(1j * rng.uniform(-math.pi, math.pi))

    def hide(rng, clock):
        def reference(times_s, poses):
            here = np.array([areas.at(x, y) for x, y in poses[:, :2]])
            return times_s, poses + np.column_stack([here * off.real, here * off.imag, 0 * here])

        return Hidden({"off_m": [off.real, off.imag]}, reference=reference)

    return hide


def swaying_antenna(rng, scene):
    """A mast bends against the acceleration of the robot by 0.03 to 0.15 m per m/s2, and rings."""
    bend_s2, frequency = rng.uniform(0.03, 0.15), 2 * math.pi * rng.uniform(0.5, 1.2)

    def hide(rng, clock):
        def reference(times_s, poses):
            step = times_s[1] - times_s[0]
            place = poses[:, 0] + 1j * poses[:, 1]
            push = -np.gradient(np.gradient(place, step), step)
            sway, rate, state = np.empty_like(place), 0j, 0j
            for row, force in enumerate(push):
                rate += step * (frequency**2 * (bend_s2 * force - state) - 0.3 * frequency * rate)
                state += step * rate
                sway[row] = state
            return times_s, np.column_stack([(place + sway).real, (place + sway).imag, poses[:, 2]])

        return Hidden({"bend_s2": bend_s2, "frequency_rad_s": frequency}, reference=reference)

    return hide


def smoothed_poses(rng, scene):
    """Poses are means over 1 to 3 s about their stamp: corners are cut."""
    over_s = rng.uniform(1.0, 3.0)

    def hide(rng, clock):
        def reference(times_s, poses):
            half = round(over_s / 2 / (times_s[1] - times_s[0]))
            padded = np.pad(poses, ((half, half), (0, 0)), mode="edge")
            window = np.ones(2 * half + 1) / (2 * half + 1)
            columns = [np.convolve(column, window, mode="valid") for column in padded.T]
            return times_s, np.column_stack(columns)

        return Hidden({"over_s": over_s}, reference=reference)

    return hide


def quantised_poses(rng, scene):
    """Positions are rounded to a grid of 0.1 to 0.4 m."""
    grid_m = rng.uniform(0.1, 0.4)

    def hide(rng, clock):
        def reference(times_s, poses):
            rounded = np.round(poses[:, :2] / grid_m) * grid_m
            return times_s, np.column_stack([rounded, poses[:, 2]])

        return Hidden({"grid_m": grid_m}, reference=reference)

    return hide


def hard_iron(rng, scene):
    """A compass near iron: its error is a sinusoid of the heading, 2 to 8 degrees."""
    most, phase = np.deg2rad(rng.uniform(2.0, 8.0)), rng.uniform(-math.pi, math.pi)

    def hide(rng, clock):
        def reference(times_s, poses):
            error = most * np.sin(poses[:, 2] - phase)
            return times_s, poses + np.column_stack([np.zeros((len(poses), 2)), error])

        return Hidden({"most_rad": most, "phase_rad": phase}, reference=reference)

    return hide


def magnetic_places(rng, scene):
    """Steel under the floor turns the compass by 5 to 20 degrees at some places."""
    areas = Patches(rng, rng.uniform(3.0, 8.0), rng.uniform(0.1, 0.35))
    turn = sign(rng) * np.deg2rad(rng.uniform(5.0, 20.0))

    def hide(rng, clock):
        def reference(times_s, poses):
            error = turn * np.array([areas.at(x, y) for x, y in poses[:, :2]])
            return times_s, poses + np.column_stack([np.zeros((len(poses), 2)), error])

        return Hidden({"turn_rad": turn}, reference=reference)

    return hide


def stretched_map(rng, scene):
    """The map is 3 to 10 % too long along one of its axes."""
    stretch, axis = 1 + sign(rng) * rng.uniform(0.03, 0.1), int(rng.integers(2))

    def hide(rng, clock):
        factors = np.array([stretch if column == axis else 1.0 for column in range(3)])
        return Hidden({"stretch": stretch, "axis": axis}, reference=lambda t, p: (t, p * factors))

    return hide


def turning_map(rng, scene):
    """The map of the reference turns by 1 to 8 degrees a minute about its origin."""
    rate = sign(rng) * np.deg2rad(rng.uniform(1.0, 8.0)) / 60

    def hide(rng, clock):
        def reference(times_s, poses):
            place = (poses[:, 0] + 1j * poses[:, 1]) * np.exp(1j * rate * times_s)
            return times_s, np.column_stack([place.real, place.imag, poses[:, 2] + rate * times_s])

        return Hidden({"rate_rad_s": rate}, reference=reference)

    return hide


def drifting_map(rng, scene):
    """The origin of the reference drifts by 2 to 8 cm/s in some direction, each run its own."""
    speed = rng.uniform(0.02, 0.08)

    def hide(rng, clock):
        way = speed * np.exp(1j * rng.uniform(-math.pi, math.pi))

        def reference(times_s, poses):
            moved = np.outer(times_s, [way.real, way.imag, 0.0])
            return times_s, poses + moved

        return Hidden({"drift_m_s": [way.real, way.imag]}, reference=reference)

    return hide


def loop_closures(rng, scene):
    """The map jumps by 0.2 to 1 m and some degrees when a loop is closed, a few times a run."""
    far_m, turn = rng.uniform(0.2, 1.0), np.deg2rad(rng.uniform(0.5, 3.0))

    def hide(rng, clock):
        moments = np.sort(rng.uniform(0, clock.duration_s, rng.integers(4, 12)))
        jumps = np.cumsum(rng.uniform(-1, 1, (len(moments), 3)), axis=0) * [far_m, far_m, turn]
        jumps = np.vstack([np.zeros(3), jumps])

        def reference(times_s, poses):
            return times_s, poses + jumps[np.searchsorted(moments, times_s)]

        return Hidden({"moments_s": moments.tolist()}, reference=reference)

    return hide


def frozen_poses(rng, scene):
    """Now and then the reference repeats its last pose for 0.4 to 2 s."""

    def hide(rng, clock):
        _, events = bursts(rng, clock, (0.4, 2.0), (4.0, 15.0))

        def reference(times_s, poses):
            rows = np.arange(len(times_s))
            for begin, end in events:
                rows[(times_s > begin) & (times_s <= end)] = np.searchsorted(times_s, begin)
            return times_s, poses[np.minimum(rows, len(poses) - 1)]

        return Hidden({"events": events}, reference=reference)

    return hide


def drifting_yaw(rng, scene):
    """The yaw of the reference drifts by 3 to 12 degrees over each run; positions do not."""

    def hide(rng, clock):
        total = sign(rng) * np.deg2rad(rng.uniform(3.0, 12.0))

        def reference(times_s, poses):
            error = total * times_s / clock.duration_s
            return times_s, poses + np.column_stack([np.zeros((len(poses), 2)), error])

        return Hidden({"total_rad": total}, reference=reference)

    return hide


def jittered_stamps(rng, scene):
    """A pose is stamped when it arrives, 0 to 0.3 s after it was true, each by chance."""
    most_s = rng.uniform(0.1, 0.3)

    def hide(rng, clock):
        seed = int(rng.integers(2**32))

        def reference(times_s, poses):
            late_s = np.random.default_rng(seed).uniform(0, most_s, len(times_s))
            stamps = np.maximum.accumulate(times_s + late_s) + 1e-4 * np.arange(len(times_s))
            return stamps, poses

        return Hidden({"most_s": most_s}, reference=reference)

    return hide


def clock_step(rng, scene):
    """A time server sets the clock of the reference by 0.1 to 0.4 s at some moment."""
    step_s = rng.uniform(0.1, 0.4)

    def hide(rng, clock):
        at_s = float(clock.duration_s * rng.uniform(0.25, 0.75))

        def reference(times_s, poses):
            return times_s + np.where(times_s >= at_s, step_s, 0.0), poses

        return Hidden({"step_s": step_s, "moment_s": at_s}, reference=reference)

    return hide


def bent_map(rng, scene):
    """Two halves of the site were surveyed apart: beyond a line the frame is turned and shifted."""
    turn, edge = sign(rng) * np.deg2rad(rng.uniform(3.0, 10.0)), rng.uniform(-math.pi, math.pi)

    def hide(rng, clock):
        def reference(times_s, poses):
            place = poses[:, 0] + 1j * poses[:, 1]
            middle = np.median(place.real) + 1j * np.median(place.imag)
            over = ((place - middle) * np.exp(-1j * edge)).real
            bent = middle + np.exp(1j * edge) * (
                np.minimum(over, 0)
                + np.maximum(over, 0) * np.exp(1j * turn)
                + 1j * ((place - middle) * np.exp(-1j * edge)).imag
            )
            return times_s, np.column_stack([bent.real, bent.imag, poses[:, 2]])

        return Hidden({"turn_rad": turn, "edge_rad": edge}, reference=reference)

    return hide


REFERENCE = (("reference",),)
REFERENCES = {
    "multipath": Kind(multipath, REFERENCE),
    "swaying_antenna": Kind(swaying_antenna, REFERENCE),
    "smoothed_poses": Kind(smoothed_poses, REFERENCE),
    "quantised_poses": Kind(quantised_poses, REFERENCE),
    "hard_iron": Kind(hard_iron, REFERENCE),
    "magnetic_places": Kind(magnetic_places, REFERENCE),
    "stretched_map": Kind(stretched_map, REFERENCE),
    "turning_map": Kind(turning_map, REFERENCE),
    "drifting_map": Kind(drifting_map, REFERENCE),
    "loop_closures": Kind(loop_closures, REFERENCE),
    "frozen_poses": Kind(frozen_poses, REFERENCE),
    "drifting_yaw": Kind(
        drifting_yaw, REFERENCE, acceptable=("sensor heading gradual",), course="gradual"
    ),
    "jittered_stamps": Kind(jittered_stamps, REFERENCE, acceptable=("late stamps",)),
    "clock_step": Kind(
        clock_step, (("reference", "late stamps from_a_moment"),), course="from_a_moment"
    ),
    "bent_map": Kind(bent_map, REFERENCE),
}
