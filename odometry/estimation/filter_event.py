"""What a filter noticed of its sensors, and when."""

from dataclasses import dataclass


@dataclass(frozen=True)
class FilterEvent:
    """One thing that a filter noticed.

    Attributes
    ----------
    kind : str
        A word for programs: initial_yaw, reinitialised, odometry_gap ...
    begin_s, end_s : float
        Stamps between which it lasted; equal where it happened at once.
    text : str
        One sentence for people, with numbers.
    values : tuple of float
        The numbers, where a program needs them.
    """

    kind: str
    begin_s: float
    end_s: float
    text: str
    values: tuple[float, ...] = ()


def gap_event(begin_s: float, end_s: float) -> FilterEvent:
    """The event of a gap of odometry."""
    text = "odometry has a gap: the speed before it was held, and the ICRs were not updated"
    return FilterEvent("odometry_gap", begin_s, end_s, text)
