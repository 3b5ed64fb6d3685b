"""Parts of runs on one ground: what a split gives to the one side or to the other."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import BoolArray
from odometry.grounds import terrains_of
from odometry.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.errors import WindowError
from odometry.windows.windows import Windows, windows_of


@dataclass(frozen=True, eq=False)
class Part:
    """Some rows of a run, as far as they lie on one ground.

    Attributes
    ----------
    run : Run
        Whole, with named grounds.
    name : str
        Of the run, unlike that of any other.
    ground : str
    start, stop : int
        Rows of odometry.csv, `stop` not included.
    """

    run: Run
    name: str
    ground: str
    start: int
    stop: int

    @property
    def rows(self) -> BoolArray:
        """Whether each row (N,) of the whole run is in this part."""
        inside = np.zeros(len(self.run.odometry), dtype=np.bool_)
        inside[self.start : self.stop] = True
        return np.asarray(inside & (terrains_of(self.run) == self.ground))

    def cut(self) -> Run:
        """A run of these rows and the poses within their time, and nothing else."""
        odometry = self.run.odometry.rows(slice(self.start, self.stop))
        pose = self.run.pose
        if pose is not None:
            first = int(np.searchsorted(pose.stamps_s, odometry.stamps_s[0]))
            end = int(np.searchsorted(pose.stamps_s, odometry.stamps_s[-1], side="right"))
            pose = pose.rows(slice(first, end))
        return replace(self.run, odometry=odometry, pose=pose)


def parts_by_ground(run: Run, name: str) -> dict[str, Part]:
    """All of a run, by ground."""
    grounds = dict.fromkeys(map(str, terrains_of(run)))
    return {ground: Part(run, name, ground, 0, len(run.odometry)) for ground in grounds}


def halves(part: Part) -> tuple[Part, Part]:
    """A part cut where half of its wheel travel is done."""
    run = part.run
    step_m = np.append(np.diff(run.wheel_travel_m), 0.0) * part.rows
    travel_m = np.cumsum(step_m)
    middle = int(np.searchsorted(travel_m, travel_m[-1] / 2))
    middle = min(max(middle, part.start + 1), part.stop - 1)
    return replace(part, stop=middle), replace(part, start=middle)


def windows_of_parts(parts: Sequence[Part], config: WindowConfig) -> Windows:
    """Windows of parts of one ground.

    Raises
    ------
    WindowError
        If there is none.
    """
    windows = windows_of([part.cut() for part in parts], config)
    here = windows.terrain == parts[0].ground
    if not here.any():
        raise WindowError(
            f"no window lies wholly on {parts[0].ground!r} in "
            f"{', '.join(part.name for part in parts)}; choose a shorter horizon"
        )
    return windows.where(here)
