"""A clock that was set back while a bag was recorded, as its import saw."""

from collections.abc import Iterator

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level


def set_back(evidence: Evidence) -> Iterator[Finding]:
    """Moments of `[source] clock_set_back` that lie within the run."""
    source = evidence.run.settings.get("source")
    found = source.get("clock_set_back", ()) if isinstance(source, dict) else ()
    begin_s, end_s = evidence.run.odometry.stamps_s[[0, -1]]
    for one in found:
        at_s = float(one["t"])
        if not begin_s < at_s < end_s:
            continue
        moment_s = evidence.run_time_s(at_s)
        yield Finding(
            "clock_set_back",
            Level.WARNING,
            f"stamps of {', '.join(one['topics'])} go back by {one['by']:.3g} s at {moment_s:.2f} "
            "s of run time, and on from there",
            "The clock was set back while the bag was recorded (time synchronisation): messages "
            "whose stamps had been there were left out, and the robot moved on meanwhile",
            f"Use what is before and after for itself: --to {moment_s:.2f}, --from {moment_s:.2f}; "
            "or import with --time log, where the clock of the recorder was not set",
            ((moment_s, moment_s),),
        )
