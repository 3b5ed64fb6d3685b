"""What several checks ask of one recording: computed once, and kept with it."""

from collections.abc import Callable
from functools import wraps
from typing import TypeVar, cast

from odometry.checks.evidence.evidence import Evidence

Answer = TypeVar("Answer")


def once(find: Callable[[Evidence], Answer]) -> Callable[[Evidence], Answer]:
    """A function of evidence that does not look again at evidence that it knows."""

    @wraps(find)
    def found(evidence: Evidence) -> Answer:
        if find not in evidence.answers:
            evidence.answers[find] = find(evidence)
        return cast("Answer", evidence.answers[find])

    return found
