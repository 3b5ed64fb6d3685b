"""Causes that are undone: what then still differs says whether they were the right ones."""

from collections.abc import Callable, Iterable, Iterator, Sequence

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.catalogue import CATALOGUE
from odometry.checks.findings.finding import Finding, Level, disagreement
from odometry.checks.findings.undo import Mend, between, in_turn
from odometry.checks.imu.gyroscope_by_poses import scales_apart
from odometry.checks.unexplained.disagreement import against_slip, lasting_disagreements
from odometry.checks.unexplained.strange_parts import strange_part

MOMENTS = frozenset({"pose_jumps", "yaw_jumps", "recordings_joined"})  # are undone by a cut
# Their time is left out: what then differs was not of the treads in it.
LOST = frozenset({"stuck_encoder", "treads_frozen", "turn_blocked"})
# Cannot be undone: what differs must be such as slip, or a constant rate, explains.
SLIP = frozenset({"slip", "gyroscope_bias"})
DISAGREE = "sensors_disagree"
# Of two sensors, and true only where these agree otherwise; nothing undoes them.
OF_AGREEMENT = frozenset(
    {*SLIP, "slip_in_turns", "track_width", "treads_not_proportional", "position_axes"}
    | {"smoothed_poses", "smoothed_treads", "treads_unsigned"}
)
AROUND_S = 2.0  # of such a moment that is left out
LEAST_S = 15.0  # of a part between two cuts
HALF = 0.5  # of the recording, that parts are at least: with more cuts it is compared whole
MOST_PARTS = 6  # the longest ones are compared
# Sensors of different times seem to slip, to jump and to be far from the centre; one side of
# another scale seems to scale the way; treads seem to stand where their scale is another elsewhere;
# one side that loses samples seems to have another scale; yaw of another unit seems to jump.
TRIED_ALONE = frozenset(
    {
        "pose_late",
        "yaw_late",
        "positions_late",
        "clocks_apart",
        "latency_changes",
        "clock_set",
        "gyroscope_late",
        "treads_late",
        "treads_are_commands",
    }
    | {"tread_late", "treads_unequal", "tread_scale_changed", "dropped_speeds"}
    | {"yaw_in_degrees", "changed_in_part"}
)
# The same where nothing is warned of but what these make: a sensor far from the centre goes too far
# where the robot turns to one side; of a yaw rate in another unit small turns seem large.
TRIED_AGAINST = {
    "far_sensor": frozenset({"scale", "slip"}),
    "gyroscope_unit": frozenset({"gyroscope_unrelated"}),
}

Found = Callable[[Evidence], Iterator[Finding]]


def alone(evidence: Evidence, found: Sequence[Finding], find: Found) -> list[Finding]:
    """A cause that leaves no warning when it alone is undone, and the notes; else all findings.

    Its consequences vanish with it.
    """
    warnings = _warnings(found)
    names = {cause.name for cause in warnings}
    causes = [
        cause
        for cause in warnings
        if cause.name in TRIED_ALONE
        or (cause.name in TRIED_AGAINST and names <= {cause.name} | TRIED_AGAINST[cause.name])
    ]
    only = _explains_all(evidence, causes, find) if len(warnings) > 1 else None
    return list(found) if only is None else [only, *_notes(found)]


def _explains_all(evidence: Evidence, causes: Sequence[Finding], find: Found) -> Finding | None:
    """The first cause that leaves no warning when it alone is undone."""
    for cause in causes:
        if cause.mend is None:
            continue
        left = find(Evidence(cause.mend(evidence.run)))
        if not any(finding.level is Level.WARNING for finding in left):
            return cause
    return None


def _notes(found: Iterable[Finding]) -> list[Finding]:
    return [finding for finding in found if finding.level is Level.NOTE]


def confirmed(evidence: Evidence, found: Sequence[Finding], find: Found) -> list[Finding]:
    """The findings; causes that leave the sensors apart when they are undone are named no more.

    All of them are undone together: columns and stamps are mended, the recording is cut at jumps,
    and stretches that other findings name are left out. What stays is compared in absolute terms:
    it is not enough that it is less than before. Where they fail together, one of them may be
    the only one: a turn that is reversed seems to be late where the drive repeats itself. The
    recording with all of them undone must pass the check as well.
    """
    warnings = _warnings(found)
    causes = [finding for finding in warnings if finding.mend is not None]
    jumps = [finding for finding in warnings if finding.name in MOMENTS]
    others = [f for f in warnings if f not in causes and f not in jumps]
    spans = tuple(span for finding in others for span in finding.spans_s)
    lost = [finding for finding in others if finding.name in LOST]
    factors = [finding for finding in others if finding.name in OF_AGREEMENT]
    if not causes and not jumps and not lost:
        slips = [finding for finding in factors if finding.name in SLIP]
        apart = against_slip(evidence) if slips else []
        return _unnamed(found, factors, apart) if apart else list(found)
    mends: list[Mend] = [finding.mend for finding in causes if finding.mend is not None]
    cuts = sorted(span[0] for finding in jumps for span in finding.spans_s)
    changed = bool(mends or spans)
    whole = Evidence(in_turn(*mends)(evidence.run), spans) if changed else evidence
    left = _left(_parts(whole, cuts))
    if cuts:  # jumps are outliers of the whole, parts may be short
        more = scales_apart(whole), strange_part(whole, cuts)
        left = list(dict.fromkeys([*left, *filter(None, more)]))
    elif not left and mends and not factors:  # which cannot be undone
        left = [finding.seen for finding in find(whole) if finding.name == DISAGREE]
    others_alone = [cause for cause in causes if cause.name not in TRIED_ALONE]  # before
    only = _explains_all(evidence, others_alone, find) if left and len(warnings) > 1 else None
    if only is not None:
        return [only, *_notes(found)]
    return _unnamed(found, [*causes, *jumps, *lost, *factors], left) if left else list(found)


def _warnings(found: Iterable[Finding]) -> list[Finding]:
    return [finding for finding in found if finding.level is Level.WARNING]


def _parts(whole: Evidence, cuts_s: Sequence[float]) -> list[Evidence]:
    """What is said between cuts; what is left out is in run time of the whole."""
    if not cuts_s:
        return [whole]
    run = whole.run
    first_s, last_s = run.odometry.stamps_s[[0, -1]]
    begins = [first_s, *(run.began_s + cut_s + AROUND_S for cut_s in cuts_s)]
    ends = [*(run.began_s + cut_s - AROUND_S for cut_s in cuts_s), last_s]
    long = [(b, e) for b, e in zip(begins, ends, strict=True) if e - b > LEAST_S]
    parts = []
    for begin_s, end_s in sorted(long, key=lambda part: part[0] - part[1])[:MOST_PARTS]:
        part = between(run, begin_s, end_s)
        if len(part.odometry) > 2:
            back_s = part.odometry.stamps_s[0] - first_s
            moved = tuple((b - back_s, e - back_s) for b, e in whole.left_out_s)
            parts.append(Evidence(part, moved))
    compared_s = sum(part.duration_s for part in parts)
    return parts if compared_s > HALF * (last_s - first_s) else [whole]


def _left(parts: Sequence[Evidence]) -> list[str]:
    found = (words for part in parts for words in lasting_disagreements(part))
    return list(dict.fromkeys(found))


def _unnamed(found: Sequence[Finding], judged: Sequence[Finding], left: list[str]) -> list[Finding]:
    """The findings, some of them joined in one disagreement, after those that are facts."""
    seen = "; ".join(finding.seen for finding in judged)
    best = ", ".join(dict.fromkeys(CATALOGUE[finding.name] for finding in judged))
    words = f"{seen}; with the likeliest cause ({best}) undone, {'; '.join(left)}"
    return [*(finding for finding in found if finding not in judged), disagreement(words)]
