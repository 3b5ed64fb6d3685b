"""A unit, a sign or the order of columns that changes while recording, and when."""

from collections.abc import Iterator, Sequence

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import TREADS
from odometry.checks.parts.candidates import Candidate, candidate, not_explained
from odometry.checks.parts.changes import CHANGES, Change
from odometry.checks.parts.drifting_side import side_drifts
from odometry.checks.parts.scaled_side import scaled_side
from odometry.checks.parts.side_in_part import side_in_part

AGREES = 0.9  # share of the turns that all sensors explain of each other: nothing changes
BETTER = 0.5  # share of what is not explained as recorded, that is left where a change is undone
EQUAL, SPINS = 0.9, 0.1  # of the rows that move: equal in a span, opposite elsewhere
AS_WELL, NEARLY = 1.3, 0.02  # times, and by how much, that what is left may be more than the least


def part_changes(evidence: Evidence) -> Iterator[Finding]:
    """What makes all sensors agree when it is undone in one span.

    The columns of one sensor are in another unit there, their sign is reversed, or they are
    exchanged. Where several such changes explain as much, all of them are named. Where none does,
    one tread may be read at another scale (`scaled_side`), or at one that drifts (`side_drifts`).
    """
    before = not_explained(evidence)
    changes = CHANGES if any(left > 1 - AGREES for left in before.values()) else ()
    found = [of for change in changes if (of := candidate(evidence, change, before)) is not None]
    pairs = set(before).union(*(one.shares for one in found))
    most = BETTER * sum(before.get(pair, 1.0) for pair in pairs)
    found = [of for of in found if of.left(pairs) < most and not _holds_one_tread(evidence, of)]
    found.sort(key=lambda of: of.left(pairs))
    if found:
        alike = AS_WELL * found[0].left(pairs) + NEARLY
        yield _finding(evidence, [one for one in found if one.left(pairs) < alike])
    else:
        in_a_span = list(scaled_side(evidence, before)) or list(side_in_part(evidence))
        yield from in_a_span or side_drifts(evidence)


def _holds_one_tread(evidence: Evidence, found: Candidate) -> bool:
    """Whether both treads are equal in its span: turned signs are those of commands to spin."""
    if found.change.sensor != "treads":
        return False
    left, right = evidence.run.odometry.stack(*TREADS).T
    moves, inside = left != 0, found.span.holds(evidence.stamps_s)
    equal, opposite = moves & (left == right), moves & (left == -right)
    spins = opposite[~inside].sum() > SPINS * moves[~inside].sum()
    return bool(equal[inside].sum() > EQUAL * moves[inside].sum() and not spins)


def _finding(evidence: Evidence, alike: Sequence[Candidate]) -> Finding:
    best, began_s = alike[0], evidence.run.began_s
    said = "; or ".join(f"{one.span.words(began_s)} {one.change.words}" for one in alike)
    several = ": without another sensor these cannot be distinguished"
    cause = f"either {said}{several}" if len(alike) > 1 else said
    table = best.change.table(evidence.gyroscope_file)
    return Finding(
        "changed_in_part",
        Level.WARNING,
        f"{best.span.words(began_s)} the turns of {_name(best.change)} differ from those of the "
        "other sensors, and elsewhere they do not",
        cause[:1].upper() + cause[1:],
        best.change.remedy,
        (best.span.run_time_s(began_s, evidence.duration_s),),
        mend=lambda run: best.change.undone(run, table, best.span),
    )


def _name(change: Change) -> str:
    return {"pose": "pose.csv", "gyroscope": "the gyroscope", "treads": "the treads"}[change.sensor]
