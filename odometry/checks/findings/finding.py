"""What a check finds in a recording."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Any

from odometry.checks.findings.undo import Mend


class Level(StrEnum):
    """How much a finding matters, most severe first."""

    REFUSED = "refused"  # cannot be read as it is: every verb stops
    WARNING = "warning"  # answers would mislead
    NOTE = "note"  # repaired, or harmless


@dataclass(frozen=True)
class Finding:
    """One thing that is odd in a recording.

    Attributes
    ----------
    name : str
        Row of the catalogue.
    level : Level
    seen : str
        What was found, with numbers.
    cause : str
        The likeliest cause. Where several cannot be distinguished, all of them, likeliest first.
    remedy : str
        What to do.
    spans_s : tuple of (float, float)
        Run time [s] from the first stamp of odometry.csv, where the oddity has a place in time.
    mend : callable of Run to Run, optional
        Undoes the cause, where it can be undone: what is left says whether it is the right one.

    Examples
    --------
    >>> from dataclasses import replace
    >>> import numpy as np
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> pose = replace(run.pose, columns={**run.pose.columns, "yaw": np.rad2deg(run.pose["yaw"])})
    >>> (finding,) = odometry.check_recording(replace(run, pose=pose)).findings
    >>> finding.name, finding.cause
    ('yaw_in_degrees', 'Yaw is in degrees')
    """

    name: str
    level: Level
    seen: str
    cause: str
    remedy: str
    spans_s: tuple[tuple[float, float], ...] = ()
    mend: Mend | None = field(default=None, compare=False, repr=False)

    @property
    def line(self) -> str:
        """The finding in one line."""
        return f"{self.level}: {self.seen}. {self.cause}. {self.remedy}."

    def to_table(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "name": self.name,
            "level": str(self.level),
            "seen": self.seen,
            "cause": self.cause,
            "remedy": self.remedy,
            "spans_s": [list(span) for span in self.spans_s],
        }


@dataclass(frozen=True)
class CheckReport:
    """All findings of one recording, most important first.

    Attributes
    ----------
    folder : Path
    findings : tuple of Finding
        By level; within a level a cause is listed before its consequences.
    skipped : tuple of str
        What could not be checked, and why.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> report = odometry.check_recording(run)
    >>> report.name, report.misleads
    ('demo', False)
    """

    folder: Path
    findings: tuple[Finding, ...]
    skipped: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Name of the run folder."""
        return self.folder.resolve().name

    @property
    def misleads(self) -> bool:
        """Whether answers from this recording would mislead, or there can be none."""
        return any(finding.level is not Level.NOTE for finding in self.findings)

    def at(self, level: Level) -> tuple[Finding, ...]:
        """Findings of one level."""
        return tuple(finding for finding in self.findings if finding.level is level)

    def with_more(self, findings: Iterable[Finding], skipped: Iterable[str] = ()) -> "CheckReport":
        """The same with findings of another check."""
        return CheckReport(
            self.folder, in_order([*self.findings, *findings]), (*self.skipped, *skipped)
        )

    def to_table(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "run": self.name,
            "misleads": self.misleads,
            "findings": [finding.to_table() for finding in self.findings],
            "skipped": list(self.skipped),
        }


def counted(count: int, noun: str) -> str:
    """A number and a noun: 1 row, 2 rows."""
    return f"{count} {noun}{'' if count == 1 else 's'}"


def in_order(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """Most severe first; findings of one level keep their order."""
    rank = list(Level)
    return tuple(sorted(findings, key=lambda finding: rank.index(finding.level)))


def disagreement(seen: str) -> Finding:
    """The finding where sensors differ and the cause cannot be determined."""
    return Finding(
        "sensors_disagree",
        Level.WARNING,
        seen,
        "The cause cannot be determined: no single known fault explains it",
        "See where they differ: terrain-odometry check --picture FILE.png",
    )
