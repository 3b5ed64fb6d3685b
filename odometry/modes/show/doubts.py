"""Why no mode is named although one is probable, and which checks the data do not allow."""

import numpy as np

from odometry.arrays import BoolArray
from odometry.modes.checks.between_modes import BetweenModes
from odometry.modes.follow.followed import Followed
from odometry.modes.models.mode_set import UNDETERMINED
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.recorded.turning_points import WINDOW_S, TurningPoints
from odometry.modes.show.doubt import Doubt, share_of_time, when
from odometry.modes.show.gain_words import gain_words
from odometry.modes.show.gyroscope_doubts import of_gyroscope

LEAST_DOUBT = 0.1  # of the time: less is not reported
MOST_SCATTER = 2.0  # times that of identification: other faults of poses and terrains reach 1.5


def doubts(followed: Followed) -> tuple[Doubt, ...]:
    """Those that hold for a tenth of the time or longer, the longest first."""
    track = followed.last_track
    undetermined = followed.answers(track) == UNDETERMINED
    found = of_gyroscope(followed, undetermined)
    if track.alike is not None:
        sure = track.probabilities.max(axis=1) >= followed.config.sure
        alike = track.alike.any(axis=1) & sure & undetermined
        found.append(
            Doubt(
                "the drive does not distinguish the most probable mode from another for "
                f"{round(100 * share_of_time(followed, alike))} % of the time",
                "drive turns of several radii to both sides: there modes differ most; where poses "
                "are measured, traction modes distinguish terrains by sideways motion as well",
                share_of_time(followed, alike),
            )
        )
    found += _of_motion(followed, undetermined)
    found += _of_gain(followed, undetermined)
    found += _of_drift(followed, undetermined)
    said = [one for one in found if one.share >= LEAST_DOUBT]
    return tuple(sorted(said, key=lambda one: -one.share))


def _of_motion(followed: Followed, undetermined: BoolArray) -> list[Doubt]:
    """Turns and measured travel that contradict the most probable mode."""
    track = followed.last_track
    counts = undetermined & (track.probabilities.max(axis=1) >= followed.config.sure)
    at_times = (
        (
            track.turns_are_off,
            "the robot turns by more or by less than the most probable mode predicts",
            "identify a mode for this terrain and load, and check the counts of both treads",
        ),
        (
            track.contradicted,
            "the motion contradicted the most probable mode, then or not long before,",
            "identify a mode for this terrain, load or set of wheels, and check poses, "
            "gyroscope and both treads",
        ),
        (
            track.centre,
            "the robot turns about another point than on the most probable mode",
            "identify a mode for this terrain, load or set of wheels, and check the poses",
        ),
        (
            track.headings_disagree,
            "gyroscope and measured headings turn apart by more than a third of what "
            "distinguishes the most probable mode from the next",
            "check the gyroscope (range, scale, mounting, temperature) and the headings",
        ),
    )
    found = []
    for off, said, advice in at_times:
        if off is not None:
            share = share_of_time(followed, off & counts)
            found.append(Doubt(f"{said} for {round(100 * share)} % of the time", advice, share))
    if track.between is not None and track.between.holds.any():
        found.append(_between(followed, track.between))
    return [*found, *_of_poses(followed), *_of_travel(followed)]


def _of_poses(followed: Followed) -> list[Doubt]:
    """Poses that scatter, and treads that turn while the robot does not."""
    track, found = followed.last_track, []
    if track.scatter is not None and (track.scatter > MOST_SCATTER).any():
        off = track.scatter > MOST_SCATTER
        found.append(
            Doubt(
                f"the poses scatter {np.median(track.scatter[off]):.1f} times as far as in the "
                f"runs of identification, {when(followed, off)}",
                "identify the modes from runs with poses as noisy as these, or take velocity "
                "modes, which are recognised by the gyroscope",
                share_of_time(followed, off),
            )
        )
    if track.blocked is not None and track.blocked.any():
        found.append(
            Doubt(
                "the treads turn on the spot and the robot does not turn, "
                f"{when(followed, track.blocked)}",
                "look whether the robot was blocked, its wheels spun, or the log held old speeds",
                share_of_time(followed, track.blocked),
            )
        )
    return found


def _of_travel(followed: Followed) -> list[Doubt]:
    """Measured positions that went farther or less far than the most probable mode says."""
    track = followed.last_track
    if track.travel is None:
        return []
    most = track.probabilities.argmax(axis=1)
    off = track.travel.off[np.arange(len(most)), most]
    if not off.any():
        return []
    ratio = float(np.median(track.travel.ratio[off, most[off]]))
    return [
        Doubt(
            f"measured positions went {ratio:.2f} times as far as the most probable mode "
            f"says, {when(followed, off)}",
            "check the size and pressure of the tyres, the load, and the positions",
            share_of_time(followed, off),
        )
    ]


def _of_gain(followed: Followed, undetermined: BoolArray) -> list[Doubt]:
    """Turns of another gain than that of the most probable mode."""
    track, modes = followed.last_track, followed.mode_set.modes
    if track.gain is None:
        return []
    off = track.gain.off & undetermined & (track.probabilities.max(axis=1) >= followed.config.sure)
    if not off.any():
        return []
    said = gain_words(track, track.gain, modes.turn_gains().mean(axis=1), off)
    return [
        Doubt(
            f"the robot turns by {said}, which is more than such turns differ by, for "
            f"{round(100 * share_of_time(followed, off))} % of the time",
            "identify a mode for this terrain, load or set of wheels, and check both treads",
            share_of_time(followed, off),
        )
    ]


def _of_drift(followed: Followed, undetermined: BoolArray) -> list[Doubt]:
    """Places that go in one direction of the world."""
    track = followed.last_track
    if track.drifts is None:
        return []
    share = share_of_time(followed, track.drifts & undetermined)
    return [
        Doubt(
            "the robot drifts in one direction of the world, which no mode does, for "
            f"{round(100 * share)} % of the time",
            "look whether it drove on a slope or was pushed or pulled, and check the poses",
            share,
        )
    ]


def _between(followed: Followed, between: BetweenModes) -> Doubt:
    """The pair between which the robot turned for longest."""
    longest = int(np.bincount(between.place[between.holds]).argmax())
    rows = between.place == longest
    first, second = between.pairs[longest]
    return Doubt(
        f"the robot turns by more than {first} and by less than {second}, "
        f"{np.median(between.share[rows]):.1f} of the way, {when(followed, rows)}: none of these, "
        "between the two",
        "identify a mode for this terrain and load; check the gyroscope's scale and both treads",
        share_of_time(followed, rows),
    )


def not_checked(followed: Followed) -> tuple[str, ...]:
    """Sentences without their full stop; of velocity modes alone, which use no poses.

    To a yaw rate a gyroscope whose scale is off is another terrain, and so is a load on both tyres.
    """
    modes, signals = followed.mode_set.modes, followed.signals
    if not isinstance(modes, VelocityModes):
        return ()
    found = [
        "terrains that the set does not hold: one on which the robot moves as on a mode of the set "
        "gets the name of that mode"
    ]
    if signals.heading_check is None:
        found.append(
            "the scale of the gyroscope, without measured headings: one that is off turns as "
            "another terrain does, and yaw rate alone does not distinguish the two"
        )
    if signals.travel is None or modes.speed_power is None:
        missing = "measured positions" if signals.travel is None else "measured speeds in the set"
        found.append(
            f"the distance, without {missing}: a load on both tyres turns as another terrain does"
        )
    missing = _missing_of_point(signals.turning_points, modes)
    if missing:
        found.append(
            f"about which point the robot turns, without {missing}: a load that shifts turns as "
            "another terrain does"
        )
    return tuple(found)


def _missing_of_point(points: TurningPoints | None, modes: VelocityModes) -> str:
    """What a run or the set lacks to hold the point of a turn against the set; "" if nothing."""
    if points is None:
        return "measured yaw"
    if not np.isfinite(modes.turning_most_m):
        return "measured yaw in the runs of the set"
    return "" if len(points.ends_s) else f"{WINDOW_S:g} s of measured yaw in which it turns enough"
