"""What the numbers of pose.csv show by themselves: frames, rounding, filling, noise."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.heading import headings
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import times
from odometry.checks.poses.coarse_positions import coarse_positions
from odometry.checks.poses.position_noise import noisy_positions
from odometry.checks.units.unit_findings import beyond_treads
from odometry.windows.recorded.interpolated import FEWEST, MOST, interpolated, line_ends, on_lines

EARTH_M = (6.2e6, 6.5e6)  # distance from the centre of the earth
MAP_M = 1e5  # coordinates above are of a map of the country (UTM)
EQUATOR_M, WEB_MAP_M = 6_378_137.0, 2.004e7  # radius, and half the width of such a map
FARTHEST = 1.1  # m for each metre of the treads: no robot goes farther
STRETCHED = (0.75, 1.1)  # the same, of positions whose stretch is undone
CUTS_RAD = 0.1  # turn on a line between two poses, that the line does not show
SAME_RAD = 0.003  # yaw and course this near are one thing written twice
OF_NOISE = 0.5  # of the noise of the course by its third differences, that such a yaw has
SMOOTHED = "; or a filter smoothed yaw and positions of a robot that hardly slides"


def pose_values(evidence: Evidence) -> Iterator[Finding]:
    """Map and earth frames, coarse, interpolated and noisy positions, a yaw that is no heading."""
    pose, used = evidence.run.pose, evidence.poses_used
    if pose is None or used is None or used.sum() < 20:
        return
    rows = np.flatnonzero(used)
    positions, stamps_s = pose.stack("x", "y")[rows], pose.stamps_s[rows]
    yield from _frame(evidence, positions)
    new = np.concatenate([[True], (np.diff(positions, axis=0) != 0).any(axis=1)])
    yield from coarse_positions(evidence, stamps_s, positions)
    yield from _interpolated(evidence, stamps_s, positions)
    yield from noisy_positions(evidence, stamps_s[new], positions[new])
    if evidence.yaw_measured:
        yield from _yaw_constant(evidence, rows)
        every = np.flatnonzero(np.isfinite(pose.stack("x", "y", "yaw")).all(axis=1))
        yield from _yaw_is_course(evidence, every, pose.stack("x", "y")[every])
        yield from _quaternion(evidence)


def _frame(evidence: Evidence, positions: FloatArray) -> Iterator[Finding]:
    pose, truth = evidence.run.pose, evidence.run.truth
    middle = np.median(positions, axis=0)
    far = float(np.hypot(*middle))
    height = 0.0
    if pose is not None and "z" in pose and np.isfinite(pose["z"]).any():
        height = float(np.nanmedian(pose["z"]))
    if EARTH_M[0] < float(np.hypot(far, height)) < EARTH_M[1] and (
        abs(height) > 1e5 or np.abs(middle).min() > 1e6
    ):
        yield _finding(
            "earth_centred",
            f"positions lie {np.hypot(far, height):.4g} m from their origin",
            "Positions are earth-centred (ECEF), not of a local plane",
            "Convert to local metres east and north",
        )
    elif stretch := _of_web_map(evidence, middle):
        yield stretch
    elif far > MAP_M:
        level = Level.NOTE
        more = ""
        if truth is not None:
            apart = float(np.hypot(*(middle - np.median(truth.stack("x", "y"), axis=0))))
            if apart > 1e3:
                level = Level.WARNING
                more = f", {apart:.4g} m from truth.csv, which is in a local frame"
        yield Finding(
            "map_frame",
            level,
            f"positions lie around ({middle[0]:.6g}, {middle[1]:.6g}) m{more}",
            "Positions are of a map (UTM or national grid), not local",
            "Subtract the first position; mind that grid north is not true north",
        )


def _of_web_map(evidence: Evidence, middle_m: FloatArray) -> Finding | None:
    """Positions of web maps, longer by one over the cosine of the latitude that y says."""
    along = beyond_treads(evidence) or evidence.metres_per_metre
    if along is None or not MAP_M < abs(middle_m[1]) < WEB_MAP_M or abs(middle_m[0]) > WEB_MAP_M:
        return None
    latitude = 2 * np.arctan(np.exp(middle_m[1] / EQUATOR_M)) - np.pi / 2
    stretch = float(1 / np.cos(latitude))
    if along < FARTHEST or not STRETCHED[0] < along / stretch < STRETCHED[1]:
        return None
    return replace(
        _finding(
            "web_map_positions",
            f"positions lie around ({middle_m[0]:.6g}, {middle_m[1]:.6g}) m, and the robot moves "
            f"{along:.3g} m for each m of tread travel",
            "Positions are of a web map (Web Mercator, EPSG:3857), which is stretched by "
            f"{stretch:.3f} at {np.degrees(latitude):.1f} degrees of latitude",
            "Convert longitude and latitude to local metres, or divide x and y by "
            f"{stretch:.4f} after subtracting the first position",
        ),
        mend=times("pose", 1 / stretch, "x", "y"),
    )


def _interpolated(
    evidence: Evidence, stamps_s: FloatArray, positions: FloatArray
) -> Iterator[Finding]:
    moving, on_line = on_lines(stamps_s, positions)
    if moving.sum() < FEWEST:
        return
    velocity = np.diff(positions, axis=0) / np.diff(stamps_s)[:, None]
    change = np.hypot(*np.diff(velocity, axis=0).T)[moving[1:-1]]
    if np.quantile(change, 0.98) < 0.05 * np.median(np.hypot(*velocity.T)):
        return  # a steady drive on a straight line: poses between two others say nothing more
    share = float(on_line[moving].mean())
    if share > MOST:
        left_out = interpolated(stamps_s, positions).any()
        cuts = (
            not left_out and _turned_rad(evidence, stamps_s[line_ends(on_line & moving)]) > CUTS_RAD
        )
        yield Finding(
            "interpolated_poses",
            Level.WARNING if cuts else Level.NOTE,
            f"{100 * share:.0f} % of the poses lie exactly on the line between their neighbours",
            "Poses are interpolated (resampled) between fewer measured ones: the lines cut curves "
            "short, and parameters identified from them are biased",
            "Keep the measured ones: the others share their noise and seem too good"
            + ("; `identify`, `compare` and `gap` leave the others out" if left_out else ""),
        )


def _turned_rad(evidence: Evidence, lines_s: FloatArray) -> float:
    """Median turn of the robot on lines (L, 2) between stamps, by gyroscope, else by treads."""
    of = evidence.integrals
    begin_s, end_s = lines_s.T
    turned = of.gyroscope_rad(end_s) - of.gyroscope_rad(begin_s)
    if not np.isfinite(turned).any():
        travel = (of.right_m(s) - of.left_m(s) for s in (end_s, begin_s))
        turned = np.subtract(*travel) / (3 * evidence.run.robot.track_width)
    return float(np.nanmedian(np.abs(turned))) if np.isfinite(turned).any() else 0.0


def _yaw_constant(evidence: Evidence, rows: IntArray) -> Iterator[Finding]:
    assert evidence.run.pose is not None  # noqa: S101 - checked by the caller
    yaw = evidence.run.pose["yaw"][rows]
    turned = float(np.nansum(np.abs(evidence.uniform.gyroscope_rad)))
    if evidence.yaw_rate is None:
        turned = float(np.sum(np.abs(evidence.uniform.difference_m))) / (
            3 * evidence.run.robot.track_width
        )
    if np.ptp(yaw) < 1e-3 and turned > 2.0:
        yield _finding(
            "yaw_constant",
            f"yaw of pose.csv stays {yaw[0]:.4g} while the robot turns by {turned:.1f} rad in all",
            "Yaw was not measured: it is constant, a placeholder",
            "Leave yaw empty: positions alone are used then",
        )


def _yaw_is_course(evidence: Evidence, rows: IntArray, positions: FloatArray) -> Iterator[Finding]:
    """The direction from one position to the next, written as yaw: not where the robot points."""
    assert evidence.run.pose is not None  # noqa: S101 - checked by the caller
    yaw = evidence.run.pose["yaw"][rows]
    steps = np.diff(positions, axis=0)
    moving = np.hypot(*steps.T) > 0.3 * np.quantile(np.hypot(*steps.T), 0.9)
    if moving.sum() < 20:
        return
    central = positions[2:] - positions[:-2]
    courses = (
        (np.arctan2(steps[:, 1], steps[:, 0])[moving], yaw[:-1][moving]),
        (np.arctan2(steps[:, 1], steps[:, 0])[moving], yaw[1:][moving]),
        (np.arctan2(central[:, 1], central[:, 0])[moving[1:]], yaw[1:-1][moving[1:]]),
    )
    for course, at in courses:
        off = np.abs(np.angle(np.exp(1j * (course - at))))
        if float(np.median(off)) < SAME_RAD and np.ptp(yaw) > 0.5:
            rough_rad = np.median(np.abs(np.diff(np.unwrap(course), n=3))) / np.sqrt(20)
            has_noise = float(np.median(off)) < OF_NOISE * rough_rad
            yield _finding(
                "yaw_is_course",
                f"yaw of pose.csv is the direction between neighbouring positions to within "
                f"{np.median(off):.1g} rad",
                f"{'Yaw' if has_noise else 'Either yaw'} is the course over ground, computed from "
                "positions: not the heading (wrong backwards, on the spot and where the robot "
                f"slides){'' if has_noise else SMOOTHED}",
                "Leave yaw empty: positions alone are used then",
            )
            return


def _quaternion(evidence: Evidence) -> Iterator[Finding]:
    """The z of a quaternion in place of yaw: its sine of half the heading fits the course."""
    raw = evidence.raw_motion
    largest = float(np.max(np.abs(raw.yaw_rad), initial=0.0, where=np.isfinite(raw.yaw_rad)))
    if not 0.3 <= largest <= 1.0001:
        return
    read = raw.with_yaw(lambda z: 2 * np.arcsin(np.clip(z, -1.0, 1.0)))
    plain, half = (headings(m, evidence.turn_rad(m)).get("radians") for m in (raw, read))
    if plain is None or half is None or half.concentration < plain.concentration + 0.1:
        return
    if half.concentration < 0.8:
        return
    yield _finding(
        "yaw_is_quaternion",
        f"yaw of pose.csv lies within -1 and 1, and twice its arc sine agrees with the course "
        f"(concentration {half.concentration:.2f}, as recorded {plain.concentration:.2f})",
        "Yaw holds a component (z) of a quaternion, not an angle",
        "Convert: yaw = atan2(2 (w z + x y), 1 - 2 (y^2 + z^2))",
    )


def _finding(name: str, seen: str, cause: str, remedy: str) -> Finding:
    return Finding(name, Level.WARNING, seen, cause, remedy)
