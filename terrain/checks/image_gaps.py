"""Stretches on which the robot drives and no image is taken."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.findings.finding import Finding, Level, counted
from odometry.recording.run import Run

# By the treads, without an image: terrain that is shorter than 2 m is rarely listed in any case.
# Cameras that take an image for each metre or more have as long a way between all of them
LEAST_M, TIMES, USUAL = 2.0, 5.0, 0.9
SHOWN = 3  # gaps that are listed


def image_gaps(run: Run) -> Iterator[Finding]:
    """Gaps of images on the way of the robot, also before the first and after the last."""
    if run.images is None or not len(run.images):
        return
    first_s, last_s = float(run.odometry.stamps_s[0]), float(run.odometry.stamps_s[-1])
    inside = run.images.stamps_s
    inside = inside[(inside >= first_s) & (inside <= last_s)]
    if len(inside) < 2:
        return
    edges_s = np.concatenate([[first_s], inside, [last_s]])
    travel_m = np.diff(np.interp(edges_s, run.odometry.stamps_s, run.wheel_travel_m))
    usual_m = float(np.quantile(travel_m[1:-1], USUAL))
    gaps = np.flatnonzero(travel_m > max(LEAST_M, TIMES * usual_m))
    if not len(gaps):
        return
    spans = tuple((float(edges_s[k]) - first_s, float(edges_s[k + 1]) - first_s) for k in gaps)
    words = [
        f"from {begin:.1f} to {end:.1f} s, in which the robot drives {travel_m[k]:.3g} m"
        for k, (begin, end) in zip(gaps[:SHOWN], spans, strict=False)
    ]
    more = f", and {counted(len(gaps) - SHOWN, 'more gap')}" if len(gaps) > SHOWN else ""
    yield Finding(
        "images_gap",
        Level.NOTE,
        f"no images {'; '.join(words)}{more}",
        "Images were not recorded, were lost or were left out there: labels of the terrain are "
        "missing",
        "Nothing to do where the terrain does not change there; else name it",
        spans,
    )
