"""What bags hold of a topic."""

from dataclasses import dataclass, field
from typing import Any

from odometry.bags.motion_seen import Ranges


@dataclass(frozen=True)
class Topic:
    """What the bags hold of a topic.

    Attributes
    ----------
    name, message_type : str
    count : int
    first_ns, last_ns : int
        When the first and the last message were received.
    sample : object or None
        The first message that could be decoded, images without their pixels.
    header_offset_s : float or None
        Median of header stamp minus time of reception; None where there is no header stamp.
    ranges : Mapping
        Of the numbers that tell motion, see `motion_seen`.
    problem : str
        Why it cannot be read; empty where it can.
    """

    name: str
    message_type: str
    count: int
    first_ns: int
    last_ns: int
    sample: Any = None
    header_offset_s: float | None = None
    ranges: Ranges = field(default_factory=dict)
    problem: str = ""

    @property
    def duration_s(self) -> float:
        """Between the first and the last message."""
        return (self.last_ns - self.first_ns) / 1e9

    @property
    def rate_hz(self) -> float:
        """Mean rate; 0 of a single message."""
        return (self.count - 1) / self.duration_s if self.duration_s > 0 else 0.0


def header_ns(content: Any) -> int:
    """Header stamp of a message, 0 where it has none."""
    stamp = getattr(getattr(content, "header", None), "stamp", None)
    return max(0, stamp.sec * 10**9 + stamp.nanosec) if stamp is not None else 0
