"""What stands at the top of a page."""

from pathlib import Path

from odometry.checks.findings.finding import CheckReport, Finding, Level
from odometry.report.drawing.before_use import TITLE, before_use

DEGREES = Finding("yaw_in_degrees", Level.WARNING, "yaw spans 340", "It is in degrees", "Turn it")
PAUSE = Finding("gap_in_odometry", Level.NOTE, "2 s are missing", "A pause", "Nothing to do")


def items_of(*args):
    section = before_use(*args)
    assert section.title == TITLE
    return [item for block in section.blocks for item in block.items]


def test_a_page_without_warnings_has_no_such_section():
    assert not before_use([CheckReport(Path("yard"), (PAUSE,))]).blocks


def test_a_warning_of_several_runs_is_one_item_and_notes_come_after():
    runs = [CheckReport(Path(name), (DEGREES, PAUSE)) for name in ("yard", "lane", "hill", "yard")]
    warned, noted = items_of(runs, ["the set is of another robot"])
    assert warned.startswith("yard: yaw spans 340. It is in degrees. Turn it. ")
    assert warned.endswith("The check warns of the same in lane, hill.")
    assert noted == "The set is of another robot."
