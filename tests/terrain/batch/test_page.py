"""The page over all runs of a batch."""

from dataclasses import replace

from odometry.parameters import ParameterSet
from terrain.batch.page import write_batch_page
from terrain.batch.row import Learned, Row
from terrain.report.tables import NOTHING

NUMBERS = ("odometer_m_per_m", "odometer_deg_per_m", "estimate_m_per_m", "gyroscope_m_per_m")
GOOD = Row(
    "a",
    "a",
    numbers=dict.fromkeys((*NUMBERS, "wheel_travel_m", "duration_s"), 0.5),
    counts={"switches": 0},
)


def test_the_notes_name_the_flags_that_the_table_counts(tmp_path):
    flagged = replace(GOOD, name="b", flags=("wheel_scale", "late_poses"), notes=("It is late.",))
    learned = Learned(ParameterSet(), {}, ())
    page = write_batch_page([GOOD, flagged], learned, tmp_path / "a.html").read_text("utf-8")
    assert page.count(f"a</a></th><td>{NOTHING}</td>") == 1
    assert page.count("b</a></th><td>2</td>") == 1
    assert "Flags: wheel scale, late poses." in page
    assert page.count("It is late.") == 1
