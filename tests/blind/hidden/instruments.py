"""Faults of the instruments aboard: gyroscopes and wheel encoders.

With a faulty encoder the treads do what is asked, and the recorded speeds are wrong.
"""
# ruff: noqa: ARG001, ARG005 - all have one face, and few need all of it

import numpy as np

from tests.blind.hidden.courses import bursts, lagged, sign
from tests.blind.hidden.kind import Hidden, Kind


def gyroscope_bias(rng, scene):
    """The gyroscope reports 0.01 to 0.05 rad/s too much or too little."""
    bias = sign(rng) * rng.uniform(0.01, 0.05)

    def hide(rng, clock):
        return Hidden({"bias_rad_s": bias}, gyroscope=lambda w: w + bias)

    return hide


def gyroscope_scale(rng, scene):
    """The gyroscope reports 2 to 8 % too much or too little of each turn."""
    scale = 1 + sign(rng) * rng.uniform(0.02, 0.08)

    def hide(rng, clock):
        return Hidden({"scale": scale}, gyroscope=lambda w: scale * w)

    return hide


def warming_gyroscope(rng, scene):
    """The bias of the gyroscope moves by 0.02 to 0.08 rad/s as it warms, and settles."""
    most = sign(rng) * rng.uniform(0.02, 0.08)

    def hide(rng, clock):
        constant_s = rng.uniform(20.0, 60.0)
        bias = most * (1 - np.exp(-clock.times_s / constant_s))
        truth = {"most_rad_s": most, "constant_s": constant_s}
        return Hidden(truth, gyroscope=lambda w: w + bias)

    return hide


def bent_gyroscope(rng, scene):
    """The gyroscope falls short by a share of 3 to 15 % that grows with the rate, at 1 rad/s."""
    share = rng.uniform(0.03, 0.15)

    def hide(rng, clock):
        return Hidden({"share_s": share}, gyroscope=lambda w: w * (1 - share * np.abs(w)))

    return hide


def filtered_gyroscope(rng, scene):
    """The gyroscope's own low-pass delays it by 0.1 to 0.3 s."""
    constant_s = rng.uniform(0.1, 0.3)

    def hide(rng, clock):
        return Hidden(
            {"constant_s": constant_s}, gyroscope=lambda w: lagged(w, constant_s, clock.step_s)
        )

    return hide


def missing_ticks(rng, scene):
    """Above some speed an encoder loses ticks: what is recorded is too slow."""
    least = scene.speed_m_s * rng.uniform(0.3, 0.6)
    kept, sides = rng.uniform(0.4, 0.8), rng.permutation([True, rng.uniform() < 0.5])

    def hide(rng, clock):
        def reported(asked, treads):
            beyond = np.sign(treads) * np.maximum(np.abs(treads) - least, 0.0)
            return treads - np.where(sides, (1 - kept) * beyond, 0.0)

        truth = {"least_m_s": least, "kept": kept, "sides": sides.tolist()}
        return Hidden(truth, reported=reported)

    return hide


def coarse_encoder(rng, scene):
    """Recorded speeds are rounded down to steps of 0.08 to 0.2 m/s."""
    step = rng.uniform(0.08, 0.2)

    def hide(rng, clock):
        return Hidden({"step_m_s": step}, reported=lambda asked, v: np.trunc(v / step) * step)

    return hide


def encoder_dropouts(rng, scene):
    """An encoder reports rest for 0.2 to 1 s, now and then, while its tread runs on."""
    side = int(rng.integers(2))

    def hide(rng, clock):
        mask, events = bursts(rng, clock, (0.2, 1.0), (4.0, 15.0))
        gone = mask[:, None] & (np.arange(2) == side)
        return Hidden(
            {"side": side, "events": events}, reported=lambda asked, v: np.where(gone, 0.0, v)
        )

    return hide


def unsigned_encoder(rng, scene):
    """One encoder has no direction: its speed is always reported forward."""
    side = np.arange(2) == rng.integers(2)

    def hide(rng, clock):
        return Hidden({}, reported=lambda asked, v: np.where(side, np.abs(v), v))

    return hide


def smoothed_encoder(rng, scene):
    """Recorded speeds are means over the last 0.4 to 1.2 s: they come later than the motion."""
    over_s = rng.uniform(0.4, 1.2)

    def hide(rng, clock):
        def reported(asked, treads):
            rows = round(over_s / clock.step_s)
            total = np.cumsum(np.vstack([np.repeat(treads[:1], rows, axis=0), treads]), axis=0)
            return (total[rows:] - total[:-rows]) / rows

        return Hidden({"over_s": over_s}, reported=reported)

    return hide


GYROSCOPE = {
    "true": (("gyroscope",),),
    "acceptable": ("none",),
    "gyroscope": "always",
}
INSTRUMENTS = {
    "gyroscope_bias": Kind(gyroscope_bias, **GYROSCOPE),
    "gyroscope_scale": Kind(gyroscope_scale, **GYROSCOPE),
    "warming_gyroscope": Kind(warming_gyroscope, **GYROSCOPE, course="gradual"),
    "bent_gyroscope": Kind(bent_gyroscope, **GYROSCOPE),
    "filtered_gyroscope": Kind(filtered_gyroscope, **GYROSCOPE),
    "missing_ticks": Kind(missing_ticks),
    "coarse_encoder": Kind(coarse_encoder),
    "encoder_dropouts": Kind(encoder_dropouts, course="in_bursts"),
    "unsigned_encoder": Kind(unsigned_encoder),
    "smoothed_encoder": Kind(smoothed_encoder),
}
