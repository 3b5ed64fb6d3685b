"""Whether the terrain moves through the images as the treads moved the robot, and when they did."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.recording.run import Run
from terrain.camera.camera import Camera
from terrain.checks.fixed_parts import fixed_parts, robot_in_images
from terrain.checks.ground_steps import FEWEST_PAIRS, GroundSteps, ground_steps
from terrain.checks.image_agreement import LARGEST_LAG_S, ImageMotion
from terrain.checks.image_stretches import image_stretches
from terrain.checks.lens_from_motion import wrong_lens
from terrain.checks.lost_details import lost_details
from terrain.checks.moved_camera import moved_camera
from terrain.checks.terrain_views import TerrainViews
from terrain.checks.unrelated_images import (
    UNEXPLAINED,
    agrees,
    unexplained,
    unrelated_images,
    upside_down,
    varies,
)

EXPLAINED = 0.75  # of the loss of even motion: what the treads may leave, where images show them
BETTER = 10.0  # of the loss [nats]: what a lag or the reverse order must gain
SURE = 4.0  # standard deviations, of the lag, of the step and of the turn by images
EDGE_M = 0.1  # travel in the time of the lag: labels that are off by less hardly matter
LARGER = 1.2  # of a step by images over that of the treads, or the inverse: treads may slip
ASIDE_RAD, BACKWARDS_DEG = float(np.radians(10.0)), 150.0
POOR = 3.0  # times the usual deviations: steady cameras on terrain have 1
MIRRORED = -0.5  # of a turn by images over that of the robot


def image_motion(run: Run, camera: Camera) -> tuple[list[Finding], str]:
    """Images that are late, early, reversed or mirrored, and a camera that points elsewhere.

    Stretches on which the image stays or has no texture are findings, and are not compared; those
    on which details are lost are findings, too, and parts of the image that show the robot itself,
    whose features are not compared either.

    Returns
    -------
    list of Finding
    str
        Why nothing could be checked, or "".
    """
    views = TerrainViews(run, camera.image_size)
    stretches = image_stretches(run, camera, views)
    poor = list(stretches.findings())
    run = stretches.others()
    parts = fixed_parts(run, camera, views)
    poor += robot_in_images(parts)
    if parts is not None:
        camera = replace(camera, robot_outlines=(*camera.robot_outlines, *parts.outlines))
    poor += lost_details(run, camera, views)
    steps = ground_steps(run, camera, views)
    motion = ImageMotion(run, steps) if len(steps) >= FEWEST_PAIRS else None
    why = _doubt(motion, steps)
    others: list[Finding] = []
    if why:
        others = list(unrelated_images(run, camera, views, steps))
    elif not steps.is_steady:  # upside down, it may move much as the treads do, and change its size
        others = list(upside_down(run, camera, views, steps))
    if others:
        return poor + others, ""
    found: list[Finding] = []
    if motion is not None and why == _DISAGREE:
        found = list(wrong_lens(motion, camera, agrees=False))
    elif motion is not None:
        found = list(_findings(motion, camera))
    if why and not found:
        return poor, f"whether images show the motion of the treads: {why}"
    return poor + found, ""


_DISAGREE = (
    f"they do not agree within {LARGEST_LAG_S:g} s (images of another drive or upside down, a "
    "camera that rocks, or a robot that always moves in the same way)"
)


def _doubt(motion: ImageMotion | None, steps: GroundSteps) -> str:
    """Why it is not sure that images show the motion of the treads, or ""."""
    if motion is None:
        return (
            f"the same terrain was recognised in {len(steps)} of {steps.tried} pairs of images, "
            f"expected {FEWEST_PAIRS} or more"
        )
    loss = min(float(motion.losses[motion.best]), motion.reversed_loss)
    if loss > EXPLAINED * motion.even_loss or not motion.is_within:
        return _DISAGREE
    if steps.is_steady and varies(motion) and unexplained(motion) > UNEXPLAINED:
        return _DISAGREE
    if motion.noise > POOR:
        return (
            "they agree, but poorly (images upside down or of another lens, or a camera that rocks)"
        )
    return ""


def _findings(motion: ImageMotion, camera: Camera) -> Iterator[Finding]:
    if motion.reversed_loss < float(motion.losses[motion.best]) - BETTER:
        yield Finding(
            "images_reversed",
            Level.WARNING,
            "the terrain moves through the images as the treads did from the end of the run to "
            "its beginning",
            "The images are in the reverse order",
            "Turn the order of the files in images.csv round",
        )
        return
    yield from _late(motion)
    lens = list(moved_camera(motion, camera)) or list(wrong_lens(motion, camera))
    yield from lens
    found, best = motion.by_lag, motion.best
    gain, turn = complex(found.gains[best]), float(found.turns[best])
    unsure, unsure_turn = SURE * float(found.gain_sds[best]), SURE * float(found.turn_sds[best])
    size, aside_rad = abs(gain), float(np.angle(gain))
    if size <= unsure:
        return
    if turn + unsure_turn < MIRRORED and abs(aside_rad) < np.pi / 4:
        mirrored = replace(motion.steps, steps=motion.steps.steps * [1.0, -1.0, -1.0])
        yield _mirrored(turn, explains=agrees(ImageMotion(motion.run, mirrored)))
        return
    if abs(aside_rad) - unsure / size > ASIDE_RAD:
        yield _aside(float(np.degrees(aside_rad)))
    if not lens and (size - unsure > LARGER or size + unsure < 1 / LARGER):
        yield _larger(size, camera.height_m, Evidence(motion.run).metres_per_metre)


def _late(motion: ImageMotion) -> Iterator[Finding]:
    lag_s = float(motion.lags_s[motion.best])
    gained = float(motion.losses[len(motion.lags_s) // 2] - motion.losses[motion.best])
    lasts_s = np.diff(motion.steps.stamps_s, axis=1)[:, 0]
    speed_m_s = float(np.median(np.hypot(*motion.steps.steps.T[:2]) / lasts_s))
    if gained < BETTER or abs(lag_s) < max(SURE * motion.lag_sd_s, EDGE_M / max(speed_m_s, 1e-9)):
        return
    late = lag_s > 0
    yield Finding(
        "images_late",
        Level.WARNING,
        f"the terrain moves through the images as the treads did {abs(lag_s):.2f} s "
        f"{'earlier' if late else 'later'} (95 %: +- {2 * motion.lag_sd_s:.2f} s), by "
        f"{len(motion.steps)} pairs of images",
        "Images are stamped late: when they arrived, or by another clock"
        if late
        else "Images are stamped early, or the treads late: by another clock, or on arrival",
        f"{'Subtract' if late else 'Add'} {abs(lag_s):.2f} s {'from' if late else 'to'} the stamps "
        "of images.csv",
    )


def _mirrored(turn: float, *, explains: bool) -> Finding:
    """Whether it explains the motion in images that they are mirrored back."""
    cause = "mirrored, or the yaw rate (the treads, without a gyroscope) has the wrong sign"
    return Finding(
        "images_mirrored",
        Level.WARNING,
        f"the terrain turns through the images by {turn:.2f} times the turn of the robot",
        f"{'Images' if explains else 'Cannot be determined: images'} are {cause}",
        "Mirror the images back, or correct the sign",
    )


def _aside(aside_deg: float) -> Finding:
    degrees, side = abs(aside_deg), "left" if aside_deg < 0 else "right"
    backwards = degrees > BACKWARDS_DEG
    return Finding(
        "camera_yaw",
        Level.WARNING,
        f"the terrain comes towards the camera {degrees:.0f} degrees beside straight ahead",
        f"The camera points {degrees:.0f} degrees farther to the {side} than [camera] says"
        + (", or the images are in the reverse order" if backwards else ""),
        "Find the mount with camera --from-motion, or correct its yaw",
    )


def _larger(gain: float, height_m: float, by_positions: float | None) -> Finding:
    """The treads, where positions say the same of them as the images do; else the camera."""
    seen = f"the terrain moves {gain:.3g} times as far through the images as the treads went"
    size = f"{1 / gain:.2g} times too large" if gain < 1 else f"{gain:.2g} times too small"
    if by_positions is None:
        return Finding(
            "camera_height",
            Level.WARNING,
            seen,
            f"The camera is not {height_m:.3g} m high: {height_m / gain:.3g} m fit; or its pitch "
            f"is off; or tread speeds are {size}, or slip: without positions these cannot be "
            "distinguished",
            "Measure the height of the camera, and a straight stretch with a tape",
        )
    if 1 / LARGER < gain / by_positions < LARGER:
        return Finding(
            "scale",
            Level.WARNING,
            f"{seen}, and positions go {by_positions:.3g} m for each metre of the treads",
            f"Tread speeds are {size} (wheel radius or diameter, gear ratio), or the treads slip "
            "so much all the way; the height of the camera fits",
            "Compare a straight stretch with a tape measure, and correct the wheel radius",
        )
    fits_m = height_m * by_positions / gain
    return Finding(
        "camera_height",
        Level.WARNING,
        f"{seen} (positions: {by_positions:.3g} times)",
        f"The camera is not {height_m:.3g} m high: {fits_m:.3g} m fit (or its pitch is off)",
        "Find the mount with camera --from-motion, or measure its height",
    )
