"""Lags that are named where other stamps explain what differs, and disagreement elsewhere."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import WINDOW_S
from odometry.checks.findings.finding import Finding, disagreement
from odometry.checks.stamps.changing_latency import runs_apart
from odometry.checks.stamps.held_treads import held_treads
from odometry.checks.stamps.late_positions import apart_from_yaw
from odometry.checks.stamps.late_stamps import one_side_alone
from odometry.checks.stamps.latencies import changing
from odometry.checks.stamps.one_delay import answers, is_one_delay
from odometry.checks.stamps.parts_of_poses import late_part, turns_in_step, yaw_late
from odometry.checks.stamps.set_clocks import step_of_lag
from odometry.checks.stamps.timing import drifting, found_in, lags_of, pose_period_s
from odometry.checks.statistics.lag import Lag
from odometry.checks.statistics.relation import Relation

OF_STAMPS = frozenset({"pose_late", "gyroscope_late", "clocks_apart"})
# Shares of the squares not explained, and of the mean difference in the nine tenths of the windows
# that differ least (stops and gaps make outliers of the others), that are left with other stamps.
# Where they were late one of both is below; where yaw wanders or bends, or a gyroscope has a dead
# zone, they are 0.76 and 0.91, and more.
LEFT, ORDINARY_LEFT, ORDINARY = 0.75, 0.8, 0.9
LATE = {"pose_late": "pose", "gyroscope_late": "gyroscope", "treads_late": "treads"}
UNDECIDED = "Late stamps, or values that are smoothed (both explain the turns alike): "
UNSMOOTHED = "Log the values before they are smoothed, from one source"
# What is left of the way with other stamps, as a share of what is left as recorded: 0.58 and less
# of robots that follow later, 1.19 and more where yaw alone was late, in 46 simulated drives.
ALONG = 0.9
TURNS_ALONE = (
    "with that undone the way along differs by more: turns alone are late (a yaw that is smoothed)"
)
DIFFER = 0.02  # share of the turns not explained, below which sensors agree


def explained_lags(evidence: Evidence) -> Iterator[Finding]:
    """The findings of `timing`: turns that differ otherwise seem late by chance.

    Stamps that are late make both positions and yaw late, both treads, and their turns and way.
    """
    change = changing(evidence)
    if change is not None and not runs_apart(evidence, change):
        return  # no constant one
    lags = lags_of(evidence)
    found = list(found_in(evidence, lags))
    apart: str | None = None
    if not any(finding.name == "clocks_apart" for finding in found):
        apart = apart_from_yaw(evidence, lags.get(("pose", "treads")))
    for finding in found:
        if finding.name == "treads_late" and apart:
            continue  # their mean is not
        alone_late = len(found) == 1 and finding.name != "gyroscope_late"
        if alone_late and _goes_along(evidence, finding) is False:
            is_pose = finding.name == "pose_late" and not apart
            turns = turns_in_step(evidence, lags) if is_pose else None
            if turns is not None:
                yield yaw_late(turns, "the way along fits the treads as it is")
            else:
                apart = apart or f"{finding.seen}, but {TURNS_ALONE}"
        elif finding.name != "pose_late":
            yield from _judged(evidence, finding, lags)
        elif not apart:
            alone = "; or those of yaw alone: the positions do not decide" * (apart is None)
            yield from _judged(evidence, replace(finding, cause=finding.cause + alone), lags)
    if apart:
        yield late_part(evidence, lags) or disagreement(apart)


def _judged(
    evidence: Evidence, finding: Finding, lags: dict[tuple[str, str], Lag]
) -> Iterator[Finding]:
    wheels = lags.get(("treads", "gyroscope"))
    if finding.name == "treads_late" and any(held_treads(evidence)):
        return  # by half of the time for which they are held
    if finding.name == "treads_late" and wheels and (of := one_side_alone(evidence, wheels)):
        yield disagreement(f"{finding.seen}, but {of}")
    elif finding.name not in OF_STAMPS or _is_explained(evidence, finding):
        yield _by_one_delay(evidence, finding, lags)
    elif any(of is not None and 1 - of.explained > DIFFER for of in _relations(evidence)):
        yield disagreement(f"{finding.seen}, but with other stamps they differ by as much")


def _by_one_delay(
    evidence: Evidence, finding: Finding, lags: dict[tuple[str, str], Lag]
) -> Finding:
    """The finding where one delay explains it best; what is known where it does not, or may not."""
    if finding.name in OR_SET:
        return OR_SET[finding.name](evidence, finding, lags)
    if finding.name not in LATE:
        return finding
    found = list(answers(evidence, LATE[finding.name], lags))
    if not found or is_one_delay(found):
        return finding
    for answer in found:
        if answer.is_slower:
            return replace(finding, cause=answer.slowly, remedy=UNSMOOTHED)
        if answer.is_stepped:
            return disagreement(f"{finding.seen}, but {answer.in_steps}")
    return replace(finding, cause=UNDECIDED + finding.cause[:1].lower() + finding.cause[1:])


def _apart_or_set(
    evidence: Evidence, finding: Finding, lags: dict[tuple[str, str], Lag]
) -> Finding:
    """Clocks that run apart; where one step of their lag explains as much, what is known."""
    words, clearly = step_of_lag(evidence, *next(iter(drifting(evidence, lags).items())))
    if clearly:
        return disagreement(f"{finding.seen}, but {words}, explains the turns better")
    if words:
        apart = finding.cause[:1].lower() + finding.cause[1:]
        return replace(finding, cause=f"Either {apart}; or one was set: {words}")
    return finding


def _commands_or_set(
    evidence: Evidence, finding: Finding, lags: dict[tuple[str, str], Lag]
) -> Finding:
    """Commands, which a robot follows late all the time; what is known where the lag has a step."""
    stepped = [answer for answer in answers(evidence, "treads", lags) if answer.is_stepped]
    return disagreement(f"{finding.seen}, but {stepped[0].in_steps}") if stepped else finding


OR_SET = {"clocks_apart": _apart_or_set, "treads_are_commands": _commands_or_set}


def _goes_along(evidence: Evidence, finding: Finding) -> bool | None:
    """Whether the way along is explained better with other stamps; None where it is not known.

    Stamps that are late, and treads that are followed later, are those of way and turns alike.
    """
    before = evidence.forward_by_mean
    if finding.mend is None or before is None or pose_period_s(evidence) > WINDOW_S:
        return None
    after = Evidence(finding.mend(evidence.run), evidence.left_out_s).forward_by_mean
    if after is None:
        return None
    share = (1 - after.explained) / max(1 - before.explained, 1e-300)
    return None if ALONG < share < 1 / ALONG else share < 1


def _is_explained(evidence: Evidence, finding: Finding) -> bool:
    """Whether two sensors agree far better on the turns with the stamps mended."""
    if finding.mend is None:
        return True
    mended = Evidence(finding.mend(evidence.run), evidence.left_out_s)
    return any(
        1 - after.explained < LEFT * (1 - before.explained)
        or _ordinary_difference(after) < ORDINARY_LEFT * _ordinary_difference(before)
        for before, after in zip(_relations(evidence), _relations(mended), strict=True)
        if before is not None and after is not None
    )


def _ordinary_difference(found: Relation) -> float:
    """Mean size of the smaller residuals."""
    sizes = np.sort(np.abs(found.residuals[np.isfinite(found.residuals)]))
    return float(np.mean(sizes[: max(int(ORDINARY * len(sizes)), 1)]))


def _relations(evidence: Evidence) -> tuple[Relation | None, ...]:
    return (
        evidence.pose_turn_by_gyroscope,
        evidence.pose_turn_by_treads,
        evidence.gyroscope_by_treads,
    )
