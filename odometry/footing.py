"""The terrain under the robot: one terrain, or shares of several while it crosses an edge."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Footing:
    """The terrain in force and the shares of all terrains under the footprint.

    Attributes
    ----------
    terrain : str
        The one with the largest share, as a rule.
    shares : Mapping of str to float
        Above zero; they add up to 1. On one terrain alone its share is 1.
    """

    terrain: str
    shares: Mapping[str, float]

    @classmethod
    def of(cls, terrain: "str | Footing") -> "Footing":
        """A name is a footing on one terrain."""
        return cls(terrain, {terrain: 1.0}) if isinstance(terrain, str) else terrain

    @property
    def is_whole(self) -> bool:
        """Whether all of the footprint is on one terrain."""
        return len(self.shares) == 1
