"""What a check answers of a recording, for tests."""

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording


def warnings(run):
    return [finding.name for finding in check_recording(run).at(Level.WARNING)]


def seen(run):
    return " ".join(finding.seen for finding in check_recording(run).at(Level.WARNING))


UNKNOWN = ["sensors_disagree"]
