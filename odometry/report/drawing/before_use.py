"""What stands at the top of a page: why its numbers may mislead."""

from collections.abc import Iterable, Sequence

from odometry.checks.findings.finding import CheckReport, Finding, Level
from odometry.report.drawing.html import Listing, Section

TITLE = "Before you use these numbers"


def before_use(reports: Iterable[CheckReport], notes: Sequence[str] = ()) -> Section:
    """Warnings of the recordings' checks, then notes; a section without blocks where none is.

    A warning that several runs have is one item, in the words of the first of them.
    """
    warned: dict[str, list[tuple[str, Finding]]] = {}
    for report in reports:
        for finding in report.at(Level.WARNING):
            warned.setdefault(finding.name, []).append((report.name, finding))
    items = [*map(_item, warned.values()), *(f"{note[0].upper()}{note[1:]}." for note in notes)]
    return Section(TITLE, [Listing(items)] if items else [])


def _item(found: Sequence[tuple[str, Finding]]) -> str:
    first, finding = found[0]
    others = list(dict.fromkeys(run for run, _ in found if run != first))
    also = f" The check warns of the same in {', '.join(others)}." if others else ""
    return f"{first}: {finding.seen}. {finding.cause}. {finding.remedy}.{also}"
