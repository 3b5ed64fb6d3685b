"""A camera that was knocked or turned while recording: terrain changes its size from then on."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.findings.finding import Finding, Level
from terrain.camera.camera import Camera
from terrain.checks.ground_steps import STEADY
from terrain.checks.image_agreement import ImageMotion
from terrain.checks.lens_from_motion import fitted_pitch

FEWEST = 8  # pairs of images before the change, and after it
# Of the scale between two images: a pitch that changes by 4 degrees and more. In standard
# deviations of both medians: the place of the change is the best of some twenty
CHANGED, SURE = 0.02, 6.0


def moved_camera(motion: ImageMotion, camera: Camera) -> Iterator[Finding]:
    """A warning where one part of the run fits `[camera]`, and the other does not; at most one."""
    logs = np.log(motion.steps.scales)
    if len(logs) < 2 * FEWEST:
        return
    split = min(range(FEWEST, len(logs) - FEWEST + 1), key=lambda place: _left(logs, place))
    parts = logs[:split], logs[split:]
    before, after = (float(np.median(part)) for part in parts)
    unsure = np.hypot(*(1.25 * 1.48 * _spread(part) / np.sqrt(len(part)) for part in parts))
    if abs(after - before) < max(CHANGED, SURE * unsure) or min(abs(before), abs(after)) > STEADY:
        return
    begin_s = float(motion.run.odometry.stamps_s[0])
    at_s = float(motion.steps.stamps_s[split, 0]) - begin_s
    later = abs(after) > abs(before)
    places = np.arange(len(logs)) >= split if later else np.arange(len(logs)) < split
    when = f"{'from' if later else 'until'} about {at_s:.0f} s of run time"
    yield Finding(
        "camera_moved",
        Level.WARNING,
        f"{when} terrain becomes {100 * abs(np.expm1(after if later else before)):.1f} % "
        f"{'larger' if (after if later else before) < 0 else 'smaller'} from the first to the "
        "second image of a pair; in the rest it keeps its size",
        f"The camera was moved at about {at_s:.0f} s{_looks(motion, camera, places, when)}",
        "Cut the run there (--from, --to), and give each part its own mount",
        ((at_s, float(motion.run.odometry.stamps_s[-1]) - begin_s) if later else (0.0, at_s),),
    )


def _left(logs: FloatArray, place: int) -> float:
    parts = logs[:place], logs[place:]
    return float(sum(np.abs(part - np.median(part)).sum() for part in parts))


def _spread(part: FloatArray) -> float:
    return float(np.median(np.abs(part - np.median(part))))


def _looks(motion: ImageMotion, camera: Camera, places: BoolArray, when: str) -> str:
    """The pitch that fits one part of the run."""
    steps = motion.steps
    part = replace(
        steps,
        rows=steps.rows[places],
        stamps_s=steps.stamps_s[places],
        steps=steps.steps[places],
        scales=steps.scales[places],
        matches=tuple(steps.matches[k] for k in np.flatnonzero(places)) if steps.matches else (),
    )
    fitted = fitted_pitch(ImageMotion(motion.run, part), camera)
    if fitted is None or camera.mount is None:
        return ""
    stated = np.degrees(camera.mount[4])
    return f": {when} it points {np.degrees(fitted):.1f} degrees down, not {stated:.1f}"
