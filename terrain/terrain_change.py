"""A change of the terrain in force that no camera saw."""

from dataclasses import dataclass


@dataclass(frozen=True)
class TerrainChange:
    """A terrain that came into force because labels, the motion or another source said so.

    Attributes
    ----------
    terrain : str
    stamp_s : float
    """

    terrain: str
    stamp_s: float
