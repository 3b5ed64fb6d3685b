"""Images that are not of the drive, are listed in another order, or are upside down."""

import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.findings.finding import Finding, Level
from odometry.recording.run import Run
from terrain.camera.camera import Camera
from terrain.checks.ground_steps import (
    FEWEST_PAIRS,
    STEADY,
    GroundSteps,
    ground_steps,
    moved_terrain,
    pairs_to_compare,
)
from terrain.checks.image_agreement import LARGEST_LAG_S, ImageMotion
from terrain.checks.terrain_views import TerrainViews

# Of even motion's loss for each pair [nats], to choose between two orders, or two sides up
SOME = 0.8
VARIED = 1.5  # of even motion's loss for each pair [nats]: robots that wind have 2.8 to 6, a
# straight drive has 0.7, with which the images of another straight drive agree by chance
# Of it: own images leave 0.3 at most, by a steady camera; those of another drive 0.6 to 1.2
UNEXPLAINED = 0.5
# The same where terrain keeps its size in images that are turned, and in none as they are: they
# may be of a camera that rocks, whose own images leave 0.63 and 0.66
ROCKING = 0.75
RESIZED = 0.05  # of the scale between two images, beyond doubt: turned ones have 0.12 to 0.37
# Factor of the size, and of the turn, by which images that are put right may still be off (a mount
# measured badly, treads that slip), and their direction
OTHER, ASIDE_RAD, SURE = 2.0, float(np.radians(45.0)), 4.0
ALIKE, ALIKE_S = 0.7, 1.0  # correlation of own images' turns or speeds at a lag of up to so much
# (0.79 and more by a camera that shakes, or treads that slip; 0.3 at most by another drive)
STANDING, MANY = 0.25, 0.25  # images that repeat, or treads that spin, are no images of elsewhere

FEW = 0.33  # of the neighbours are recognised where images are in no order, at most
CLOSE = 0.5  # of the camera's height, by the treads, to the next image: most terrain is in both
FAR_M = 1.0  # by the treads, at least, between images that are no neighbours
FEWEST_OTHERS = 8  # of such pairs that show the same terrain: by chance none does


def unrelated_images(
    run: Run, camera: Camera, views: TerrainViews, steps: GroundSteps
) -> Iterator[Finding]:
    """Why images do not show the motion of the treads, where the recording says it; at most one.

    A camera that rocks, and a robot that always moves in the same way, cannot be distinguished
    from images of another drive: nothing is said of them.
    """
    turned = list(upside_down(run, camera, views, steps))
    yield from turned
    if turned:
        return
    by_name = _by_name(run)
    if by_name is not None and _shows(by_name, ground_steps(by_name, camera, views)):
        yield Finding(
            "images_unordered",
            Level.WARNING,
            "the terrain moves through the images as the treads moved the robot only when files "
            "are listed by the numbers in their names",
            "images.csv lists the files in another order: names were sorted as text, or rows were "
            "mixed",
            "List the files by their numbers, and keep the order of the stamps",
        )
        return
    if len(steps) >= FEWEST_PAIRS:
        if _is_of_another_drive(run, steps):
            yield _of_another_drive(steps)
    else:
        yield from _in_no_order(run, camera, views, steps)


def upside_down(
    run: Run, camera: Camera, views: TerrainViews, as_they_are: GroundSteps
) -> Iterator[Finding]:
    """Images that show the motion of the treads once they are turned by half a turn, or flipped.

    Parameters
    ----------
    run : Run
    camera : Camera
    views : TerrainViews
    as_they_are : GroundSteps
        By these images, not turned.
    """
    steps = ground_steps(run, camera, views.upside_down())
    changed, turned = (abs(of.scale[0]) if len(of) else 0.0 for of in (as_they_are, steps))
    most = ROCKING if changed > RESIZED and turned < STEADY else UNEXPLAINED
    if _shows(run, steps, most):
        how = "turned by half a turn"
        cause = (
            "Images are upside down: the camera hangs, its driver or a note in the files (EXIF) "
            "turns them, or the mount's roll is off by 180 degrees"
        )
        remedy = "Turn the images by half a turn, or add 180 degrees to the roll of the mount"
    elif _shows(run, replace(steps, steps=steps.steps * [1.0, -1.0, -1.0]), most):
        how, cause = "flipped", "Images are flipped: their top row is the last one"
        remedy = "Flip the images back, top to bottom"
    else:
        return
    yield Finding(
        "images_upside_down",
        Level.WARNING,
        "the terrain moves through the images as the treads moved the robot only when they are "
        + how,
        cause,
        remedy,
    )


def _shows(run: Run, steps: GroundSteps, most: float = UNEXPLAINED) -> bool:
    """Whether steps between images are those of the robot, beyond doubt."""
    if len(steps) < FEWEST_PAIRS:
        return False
    return agrees(ImageMotion(run, steps), most)


def agrees(motion: ImageMotion, most: float = UNEXPLAINED) -> bool:
    """Whether the treads explain the motion in images, in its size, direction and turn.

    At most so much may be left unexplained. A view that stays, and one that drifts aside, leave
    nothing unexplained by a step of no size.
    """
    moves = motion.plain_even_loss > SOME * len(motion.steps)
    if not (moves and unexplained(motion) < most):
        return False
    gain, gain_sd, turn, turn_sd = motion.plain_gains
    turns = turn + SURE * turn_sd > 1 / OTHER and turn - SURE * turn_sd < OTHER
    right_size = max(1 / OTHER, SURE * gain_sd) < abs(gain) < OTHER
    return bool(right_size and turns and abs(np.angle(gain)) < ASIDE_RAD)


def varies(motion: ImageMotion) -> bool:
    """Whether the treads move so variedly that images can show it."""
    return motion.plain_even_loss > VARIED * len(motion.steps)


def unexplained(motion: ImageMotion) -> float:
    """What the treads leave of the motion in images, over what even motion leaves of theirs."""
    lowest = min(float(motion.plain_losses.min()), motion.plain_reversed_loss)
    return lowest / motion.plain_even_loss


def _by_name(run: Run) -> Run | None:
    """The run with its files in the order of the numbers in their names; None if it is theirs."""
    if run.images is None:
        return None
    names = run.images["file"]
    order = sorted(range(len(names)), key=lambda place: _numbered(str(names[place])))
    if order == list(range(len(names))):
        return None
    columns = {**run.images.columns, "file": names[order]}
    return replace(run, images=replace(run.images, columns=columns))


def _numbered(name: str) -> list[tuple[int, str]]:
    """Parts of a name, in which 10 comes after 9."""
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", name)]


def _is_of_another_drive(run: Run, steps: GroundSteps) -> bool:
    """Whether a steady camera saw a motion, and at no lag that of treads which move variedly."""
    motion = ImageMotion(run, steps)
    if not (steps.is_steady and varies(motion) and unexplained(motion) > UNEXPLAINED):
        return False
    travel_m, turn_rad = motion.robot_at_lags
    seen_m = np.hypot(*steps.steps.T[:2])
    standing = seen_m < STANDING * np.abs(travel_m[len(travel_m) // 2])
    if standing.mean() > MANY:
        return False
    lasts_s, near = np.diff(steps.stamps_s, axis=1)[:, 0], np.abs(motion.lags_s) <= ALIKE_S
    turns = _alike(turn_rad[near] / lasts_s, steps.steps[:, 2] / lasts_s)
    return max(turns, _alike(travel_m[near] / lasts_s, seen_m / lasts_s)) < ALIKE


def _alike(rows: FloatArray, values: FloatArray) -> float:
    """The largest size of the correlations of each row (G, P) with values (P,)."""
    rows, values = rows - rows.mean(axis=1, keepdims=True), values - values.mean()
    sizes = np.linalg.norm(rows, axis=1) * np.linalg.norm(values)
    return float(np.max(np.abs(rows @ values) / np.maximum(sizes, 1e-12)))


def _of_another_drive(steps: GroundSteps) -> Finding:
    return Finding(
        "images_unrelated",
        Level.WARNING,
        f"the terrain moves steadily through {len(steps)} of {steps.tried} pairs of images, but "
        f"neither as the treads moved the robot within {LARGEST_LAG_S:g} s, nor in the reverse "
        "order, nor upside down",
        "Images are of another drive, of another clock, or in another order",
        "Take the images of this drive, with their own stamps",
    )


def _in_no_order(
    run: Run, camera: Camera, views: TerrainViews, steps: GroundSteps
) -> Iterator[Finding]:
    """Images whose neighbours are not recognised, while others are that are far by the treads."""
    pairs = pairs_to_compare(run, camera)
    if run.images is None or len(pairs) < FEWEST_PAIRS or len(steps) > FEW * len(pairs):
        return
    stamps_s, files = run.images.stamps_s, run.images["file"]
    travel_m = np.interp(stamps_s, run.odometry.stamps_s, run.wheel_travel_m)
    if np.median(np.diff(travel_m[pairs], axis=1)) > CLOSE * camera.height_m:
        return
    found = 0
    for first, second in combinations(np.unique(pairs).tolist(), 2):
        if abs(travel_m[second] - travel_m[first]) < FAR_M:
            continue
        same = views.same(camera, str(files[first]), str(files[second]))
        moved = None if same is None else moved_terrain(camera, same)
        found += moved is not None and abs(np.log(moved[3])) < STEADY
        if found >= FEWEST_OTHERS:
            yield Finding(
                "images_unrelated",
                Level.WARNING,
                f"the same terrain is in {len(steps)} of {len(pairs)} pairs of images that follow "
                f"each other, and in {found} pairs or more that lie {FAR_M:g} m or more apart by "
                "the treads",
                "Cannot be determined: images are in no order (rows or files were mixed), or the "
                "robot passed these places again",
                "List the files in the order in which they were taken, if that is why",
            )
            return
