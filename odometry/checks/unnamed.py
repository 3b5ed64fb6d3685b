"""The finding where no cause can be told."""

from odometry.checks.finding import Finding, Level


def disagreement(seen: str) -> Finding:
    """The finding where sensors differ and the cause cannot be told."""
    return Finding(
        "sensors_disagree",
        Level.WARNING,
        seen,
        "The cause cannot be told: no single known fault explains it",
        "Look where they part: check --picture",
    )
