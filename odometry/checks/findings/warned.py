"""What the check warns of in the recordings of an answer, in the words that stand beside it."""

from collections.abc import Iterable, Sequence

from odometry.checks.findings.catalogue import CATALOGUE
from odometry.checks.findings.finding import CheckReport, Finding, Level

NOTED = frozenset({"straight_drives", "gyroscope_scale"})  # notes that may be the cause of a gap
TRUE_SLIP = frozenset({"slip", "slip_in_turns", "slip_episodes"})  # what a robot does, no fault
RunFinding = tuple[str, Finding]  # the name of a run, and what was found there


def faults_of(reports: Iterable[CheckReport]) -> tuple[RunFinding, ...]:
    """Warnings of all runs, and notes that may explain a gap, each with the name of its run."""
    found = {
        (report.name, finding.name): (report.name, finding)
        for report in reports
        for finding in report.findings
        if finding.level is not Level.NOTE or finding.name in NOTED
    }
    return tuple(found.values())


def faults_words(faults: Sequence[RunFinding]) -> str:
    """All of them in one line; empty where there is none."""
    runs: dict[str, list[str]] = {}
    for run, finding in faults:
        runs.setdefault(finding.name, []).append(run)
    said = (f"{CATALOGUE[name]} ({name}, {', '.join(of)})" for name, of in runs.items())
    return f"Check warns: {'; '.join(said)}." if runs else ""


def sensor_faults(faults: Iterable[RunFinding]) -> list[str]:
    """Names of findings that a model may take for what the robot does."""
    return list(dict.fromkeys(one.name for _, one in faults if one.name not in TRUE_SLIP))
