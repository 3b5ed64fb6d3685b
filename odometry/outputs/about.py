"""What a result says of itself: what made it, and what the checks of its runs found."""

from collections.abc import Sequence
from typing import Any

from odometry.checks.finding import CheckReport
from odometry.outputs.made import Made


def about_result(made: Made, reports: Sequence[CheckReport]) -> dict[str, Any]:
    """Keys that are added to a result file, of plain values."""
    return {"made": made.to_table(), "check": [report.to_table() for report in reports]}
