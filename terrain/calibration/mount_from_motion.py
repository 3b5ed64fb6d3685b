"""The mount from a run: what makes the flow of the terrain agree with the odometer."""

from collections.abc import Callable
from dataclasses import replace
from itertools import product

import numpy as np
from scipy.stats import t as student

from odometry.arrays import BoolArray, FloatArray, spread
from terrain.calibration.flow_solver import GroundFlow, Solution, solve_mount
from terrain.calibration.mount_fit import MountFit, too_wide
from terrain.calibration.tracks import Tracks
from terrain.camera_files.lens_models import Lens
from terrain.errors import CalibrationError

AGAIN = 2  # features are tracked again with the mount found
FEWEST_PAIRS = 16
FEWEST_SHARE = 0.5  # of the features below the horizon that flow as terrain does
AGREES_PX = 2.0
# Features that stay, and their share in a pair of images of a frozen camera; what stays in others
# is of the robot or far away
STAYS_PX, MOST_STAYING = 0.5, 0.9
STAYS = "the image stays the same though the treads move (the camera froze, or wheels spun)"
BLOCKS = 8  # of the run, each left out once (jackknife)
SURE = 0.975
# What repeats over the whole run, such as errors of the lens, no stretch left out can show
LEAST_SHARE, LEAST_RAD = 0.005, float(np.radians(0.05))
HIGHEST_SHARE = 0.05  # of the height: a wider half interval is of no use
# The coarse search: heights, pitches and views, features of it, and how far off one may be
HEIGHTS_M = np.geomspace(0.15, 2.5, 12)
PITCHES_RAD = np.radians(np.arange(-4.0, 85.0, 4.0))
YAWS_RAD = np.radians([0.0, 180.0, 90.0, -90.0])
SEARCHED, LARGEST_PX, STARTS = 1500, 8.0, 6
COARSE_PX = 4.0  # scale of the loss at first
PLACES = np.array([2, 3, 4, 5])  # of z, roll, pitch, yaw in a mount
WORDS = ("height", "roll", "pitch", "yaw")
SCALE_NOTE = (
    "the height is as right as the odometer's metres: wheels that slip or are scaled by 1 % put it "
    "off by 1 %"
)
LENS_NOTE = (
    "the intervals hold for the lens as given: a focal length that was 13 % off moved the pitch by "
    "3 degrees, with an interval of 0.08"
)


def mount_from_motion(
    tracks: Tracks,
    lens: Lens,
    given: FloatArray | None = None,
    again: Callable[[FloatArray], Tracks] | None = None,
) -> tuple[MountFit, Tracks]:
    """Find height, roll, pitch and yaw of a camera from the flow of the terrain.

    A robot that drives on level terrain turns about the vertical alone: the direction of the flow
    gives pitch and yaw of the camera, how it grows towards the image's edge pitch and roll, its
    size the height, all relative to the odometer's motion. x and y are taken as given.

    Parameters
    ----------
    tracks : Tracks
    lens : Lens
    given : (6,), optional
        A mount; its x and y, and what the run does not determine, are kept.
    again : callable, optional
        Better tracks, made with the mount (6,) of the first ones.

    Returns
    -------
    MountFit
        Half intervals are NaN of what was kept. Errors are infinite above the horizon.
    Tracks
        The features, in the order of the errors.

    Raises
    ------
    CalibrationError
        If the run does not determine the pitch: too little texture or motion, a view that stays,
        too few features that move as terrain does, or an interval too wide.
    """
    focus_px = float(np.mean(lens.focus_px))
    followed, tracks = tracks, _moving(tracks, focus_px)
    known = np.zeros(6) if given is None else np.asarray(given, dtype=np.float64)
    flow, free = GroundFlow(tracks, known[:2], focus_px), np.ones(4, dtype=bool)
    found = _search(flow)
    _check_agreement(found)
    if again is not None:
        for _ in range(AGAIN):
            mount = np.concatenate([flow.place_m, found.values])
            flow = replace(flow, tracks=_moving(again(mount), focus_px))
            found = solve_mount(flow, found.values, free)
        _check_agreement(found)
    half = _half_interval(flow, found.values, free)
    vague = _vague(found.values, half)
    notes = [SCALE_NOTE, LENS_NOTE, *_of_staying(followed, tracks)]
    if vague[2]:
        raise CalibrationError(
            f"the run does not determine the pitch: {np.degrees(found.values[2]):.1f} degrees, "
            f"give or take {np.degrees(half[2]):.1f}; drive straight on over textured, level "
            "terrain"
        )
    if vague.any():
        free = ~vague
        start = np.where(free, found.values, known[PLACES])
        if vague[0] and given is None:
            raise CalibrationError(
                "the run does not determine the height of the camera, and none is given; drive "
                "farther"
            )
        found = solve_mount(flow, start, free)
        half = _half_interval(flow, found.values, free)
        kept = " and ".join(word for word, one in zip(WORDS, vague, strict=True) if one)
        notes.append(f"{kept} cannot be determined from this run; kept as given")
    half[~free] = np.nan
    mount, interval = known.copy(), np.full(6, np.nan)
    mount[PLACES], interval[PLACES] = found.values, half
    errors_px = np.linalg.norm(found.residuals_px, axis=1)
    errors_px = np.nan_to_num(errors_px, nan=np.inf)
    fit = MountFit(mount, interval, errors_px, tuple(notes), limit_px=AGREES_PX)
    return fit, flow.tracks


def _check(tracks: Tracks) -> None:
    if tracks.tried < FEWEST_PAIRS:
        raise CalibrationError(
            f"the run has {tracks.tried} pairs of images with 3 cm to 60 cm of travel and little "
            f"turning between them, expected at least {FEWEST_PAIRS}: the mount cannot be "
            "determined; record more images while driving"
        )
    if len(tracks.steps) < FEWEST_PAIRS:
        raise CalibrationError(
            f"features could be followed in {len(tracks.steps)} of {tracks.tried} pairs of images, "
            f"expected at least {FEWEST_PAIRS}: the terrain has too little texture, or images are "
            "too far apart; the mount cannot be determined"
        )


def _moving(tracks: Tracks, focus_px: float) -> Tracks:
    """The pairs of images in which the view does not stay."""
    _check(tracks)
    stays = np.linalg.norm(tracks.after - tracks.before, axis=1) * focus_px < STAYS_PX
    pairs = len(tracks.steps)
    counts = np.bincount(tracks.pair, minlength=pairs)
    share = np.bincount(tracks.pair, weights=stays, minlength=pairs) / np.maximum(counts, 1)
    kept = np.flatnonzero(share < MOST_STAYING)
    if len(kept) < FEWEST_PAIRS:
        raise CalibrationError(
            f"in {pairs - len(kept)} of {pairs} pairs {STAYS}. {len(kept)} pairs are left, "
            f"expected at least {FEWEST_PAIRS}: the mount cannot be determined"
        )
    return tracks.of_pairs(kept)


def _of_staying(followed: Tracks, moving: Tracks) -> list[str]:
    """How many pairs were left out because the image stays the same, if any."""
    pairs, left = len(followed.steps), len(moving.steps)
    if left == pairs:
        return []
    return [f"in {pairs - left} of {pairs} pairs {STAYS}; the mount is that of the other {left}"]


def _search(flow: GroundFlow) -> Solution:
    """The best of local searches from the best places of a coarse grid."""
    few = replace(flow, tracks=_thinned(flow.tracks))
    grid = [
        np.array([z, 0.0, pitch, yaw])
        for z, pitch, yaw in product(HEIGHTS_M, PITCHES_RAD, YAWS_RAD)
    ]
    costs = [_truncated(few, values, few.tracks.steps) for values in grid]
    every, found = np.ones(4, dtype=bool), []
    for place in np.argsort(costs, kind="stable")[:STARTS]:
        solution = solve_mount(few, grid[place], every, COARSE_PX)
        steps = few.tracks.steps + solution.motions
        found.append((_truncated(few, solution.values, steps), solution))
    best = min(found, key=lambda pair: pair[0])[1]
    return solve_mount(flow, best.values, every)


def _truncated(flow: GroundFlow, values: FloatArray, steps: FloatArray) -> float:
    """Mean error of the features, none above LARGEST_PX; rays to no terrain have that."""
    lengths = np.linalg.norm(flow.residuals(values, steps), axis=1)
    return float(np.minimum(np.nan_to_num(lengths, nan=LARGEST_PX), LARGEST_PX).mean())


def _thinned(tracks: Tracks) -> Tracks:
    kept = spread(len(tracks.pair), SEARCHED)
    before, after, pair = tracks.before[kept], tracks.after[kept], tracks.pair[kept]
    return Tracks(before, after, pair, tracks.steps, tracks.tried)


def _check_agreement(found: Solution) -> None:
    lengths = np.linalg.norm(found.residuals_px, axis=1)
    on_terrain = np.isfinite(lengths)
    share = float((lengths[on_terrain] < AGREES_PX).mean()) if on_terrain.any() else 0.0
    if share < FEWEST_SHARE:
        raise CalibrationError(
            f"only {100 * share:.0f} % of the features move as terrain would under any mount; the "
            "mount cannot be determined. Are the stamps of images and odometry of one clock, is "
            "the lens right, and is the terrain level?"
        )


def _half_interval(flow: GroundFlow, values: FloatArray, free: BoolArray) -> FloatArray:
    """Half of the 95 % interval (4,), by leaving out one stretch of the run after the other."""
    pairs = np.arange(len(flow.tracks.steps))
    each = []
    for block in np.array_split(pairs, BLOCKS):
        others = replace(flow, tracks=flow.tracks.of_pairs(np.setdiff1d(pairs, block)))
        each.append(solve_mount(others, values, free).values)
    apart = np.stack(each) - np.mean(each, axis=0)
    sigma = np.sqrt((BLOCKS - 1) / BLOCKS * (apart**2).sum(axis=0))
    half = student.ppf(SURE, BLOCKS - 1) * sigma
    return np.asarray(np.hypot(half, _least_half(values)))


def _least_half(values: FloatArray) -> FloatArray:
    return np.array([LEAST_SHARE * values[0], LEAST_RAD, LEAST_RAD, LEAST_RAD])


def _vague(values: FloatArray, half: FloatArray) -> BoolArray:
    wide = too_wide(np.concatenate([[0.0, 0.0], half]))[PLACES]
    wide[0] = not half[0] <= HIGHEST_SHARE * values[0]
    return np.asarray(wide)
