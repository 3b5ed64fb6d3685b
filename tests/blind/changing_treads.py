"""Treads whose columns go wrong little by little, are smoothed, or hold one tread twice.

`FAULTS` holds the faults by key, as those of `tests/blind/part_faults.py`; `LOOK_ALIKES` are
changes of a robot on its terrain, which are no faults: more slip, or another effective width, from
part to part or little by little. Nothing here knows how the check looks for them.
"""

import numpy as np

from tests.blind.faults.fault import UnsuitableError
from tests.blind.part_faults import TREADS, PartFault

MATERIAL = 0.05  # root mean square of what a fault changes, in that of the speeds


def _material(recording, changed):
    """The changed recording, unless the drive hardly shows the fault."""
    before, after = (
        np.stack([of["odometry"][name] for name in TREADS]) for of in (recording, changed)
    )
    if np.nanmean((after - before) ** 2) < MATERIAL**2 * np.nanmean(before**2):
        raise UnsuitableError
    return changed


def course(rng, stamps_s, span_s):
    """From 0 before a span to 1 after it (N,): straight, bent, or in an S."""
    share = np.clip((stamps_s - span_s[0]) / (span_s[1] - span_s[0]), 0.0, 1.0)
    power = float(rng.choice([1.0, 0.5, 2.0]))
    return share**power if rng.random() < 0.7 else share**2 * (3 - 2 * share)


def _to(rng, least, most):
    """A factor, most often below one."""
    factor = float(np.exp(rng.uniform(np.log(least), np.log(most))))
    return factor if rng.random() < 0.7 else 1 / factor


def ramp(least, most):
    """One tread's scale goes from 1 to another over the span, or over the whole run."""

    def change(recording, rng, span_s):
        table = recording["odometry"]
        if rng.random() < 0.5:
            span_s = (table["t"][0], table["t"][-1])
        scale = _to(rng, least, most) ** course(rng, table["t"], span_s)
        name = str(rng.choice(TREADS))
        new = recording.with_columns("odometry", **{name: scale * table[name]})
        return _material(recording, new)

    return change


def whole(least, most):
    """One tread's scale is another one all along."""

    def change(recording, rng, span_s):  # noqa: ARG001
        name, factor = str(rng.choice(TREADS)), _to(rng, least, most)
        return recording.with_columns("odometry", **{name: factor * recording["odometry"][name]})

    return change


def smoothed(least_s, most_s):
    """Both treads through a centred or a trailing mean, or a low pass of first order."""

    def change(recording, rng, span_s):  # noqa: ARG001
        table = recording["odometry"]
        t, over_s = table["t"], float(rng.uniform(least_s, most_s))
        way = str(rng.choice(["centred", "trailing", "low pass"]))
        new = {name: _smooth(t, table[name], over_s, way) for name in TREADS}
        return _material(recording, recording.with_columns("odometry", **new))

    return change


def _smooth(t, values, over_s, way):
    if way == "low pass":
        out, weights = values.copy(), 1 - np.exp(-np.diff(t) / (over_s / 2))
        for row, weight in enumerate(weights, start=1):
            out[row] = out[row - 1] + weight * (values[row] - out[row - 1])
        return out
    first = np.searchsorted(t, t - (over_s / 2 if way == "centred" else over_s))
    last = np.searchsorted(t, t + over_s / 2, "right") if way == "centred" else None
    last = np.arange(1, len(t) + 1) if last is None else last
    summed = np.append(0.0, np.cumsum(values))
    return (summed[last] - summed[first]) / (last - first)


def one_twice(recording, rng, span_s):
    """Both columns hold one tread in the span."""
    table = recording["odometry"]
    part = (table["t"] >= span_s[0]) & (table["t"] < span_s[1])
    kept, other = rng.permutation(TREADS)
    new = {str(other): np.where(part, table[kept], table[other])}
    return _material(recording, recording.with_columns("odometry", **new))


def _terrain(recording, rng, span_s, of_mean, of_difference):
    """Treads that slip more, or turn the robot less, as the span goes on or from its begin on."""
    table = recording["odometry"]
    share = course(rng, table["t"], span_s)
    share = share if rng.random() < 0.5 else np.where(share > 0, 1.0, 0.0)
    mean = (table["v_left"] + table["v_right"]) / 2 * of_mean**share
    half = (table["v_right"] - table["v_left"]) / 2 * of_difference**share
    return recording.with_columns("odometry", v_left=mean - half, v_right=mean + half)


def wider(recording, rng, span_s):
    """The effective width changes by up to 1.5 times: another terrain."""
    return _terrain(recording, rng, span_s, 1.0, float(np.exp(rng.uniform(-0.4, 0.4))))


def slipping(recording, rng, span_s):
    """Slip of up to a fifth, and the width with it."""
    slip = float(rng.uniform(1.0, 1.25))
    return _terrain(recording, rng, span_s, slip, slip * float(rng.uniform(1.0, 1.3)))


SCALED = ("scale", "times the motion of", "unit", "wears", "counts")
FAULTS = {
    fault.key: fault
    for fault in (
        PartFault("side_wears_much", ramp(0.35, 0.65), SCALED),
        PartFault("side_wears_little", ramp(0.7, 0.88), SCALED),
        PartFault("side_other_scale", whole(0.4, 0.85), SCALED),
        PartFault("smoothed_long", smoothed(2.0, 4.0), ("smooth", "filter", "mean over")),
        PartFault("smoothed_short", smoothed(0.7, 1.5), ("smooth", "filter", "mean over")),
        PartFault("one_tread_twice", one_twice, ("both columns", "copied", "copy")),
    )
}
LOOK_ALIKES = {
    fault.key: fault for fault in (PartFault("wider", wider), PartFault("slipping", slipping))
}
