"""Places ahead and behind that were labelled, and which of them are under the robot."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Self

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.recording.run import Robot

DRIFT = 0.03  # metres per metre: usual error of an odometer on its way to a labelled place


@dataclass(frozen=True)
class PlaceLabel:
    """A label and the place that it belongs to.

    Attributes
    ----------
    label : str
    stamp_s : float
        When the image was taken, or the window of feel ended.
    travel_m : float
        Wheel travel of the run then.
    place : (2,)
        The middle of the region in the odometry frame: poses that are integrated from twists
        and that no measured pose corrects, so that places do not move under the robot [m].
    distance_ahead_m : float
        Wheel travel from the robot to the place then.
    probabilities : Mapping of str to float
        What the classifier gave to each terrain; empty where only the label is known.
    by_feel : bool
        Whether the label comes from terrain by feel, and not from an image.
    is_evidence : bool
        Of an ``unknown`` label: whether the image resembles no terrain with a name. One that shows
        no terrain, or two side by side, says nothing.
    """

    label: str
    stamp_s: float
    travel_m: float
    place: FloatArray
    distance_ahead_m: float
    probabilities: Mapping[str, float] = field(default_factory=dict)
    by_feel: bool = False
    is_evidence: bool = True


@dataclass(frozen=True)
class Footprint:
    """The rectangle under the robot.

    Attributes
    ----------
    length_m, width_m : float
    scale : float
        A region is this much larger.
    """

    length_m: float
    width_m: float
    scale: float = 1.2

    @classmethod
    def of(cls, robot: Robot, scale: float) -> Self:
        """That of a robot; length and width default to the track width."""
        return cls(robot.length or robot.track_width, robot.width or robot.track_width, scale)

    @property
    def radius_m(self) -> float:
        """From the middle of a region to a corner. A place no farther away is reached."""
        return self.scale * float(np.hypot(self.length_m, self.width_m)) / 2

    @cached_property
    def middle_and_points(self) -> FloatArray:
        """Points (76, 2): the middle, and 75 spread evenly over it, in the robot frame."""
        return np.vstack([np.zeros(2), self.points])

    @cached_property
    def points(self) -> FloatArray:
        """Points (75, 2) spread evenly over the footprint, in the robot frame."""
        along = (np.arange(15) - 7) / 15 * self.length_m
        across = (np.arange(5) - 2) / 5 * self.width_m
        return np.stack(np.meshgrid(along, across), axis=-1).reshape(-1, 2)


def nearest(
    points: FloatArray, places: FloatArray, since_m: FloatArray
) -> tuple[IntArray, FloatArray]:
    """The place nearest to each point, older places counting as farther away.

    Parameters
    ----------
    points : (m, 2)
    places : (n, 2), n at least 1
    since_m : (n,)
        Wheel travel since each place was labelled.

    Returns
    -------
    (m,), (m,)
        Index of the place, and the distance with what the odometer drifted since [m].
    """
    x, y = (points[:, None, axis] - places[:, axis] for axis in (0, 1))
    apart = np.sqrt(x * x + y * y) + DRIFT * since_m
    index = apart.argmin(axis=1)
    return index, apart[np.arange(len(points)), index]


def along_way(places: FloatArray, same_m: float) -> IntArray:
    """Order of places along the way: a place that was labelled before goes beside the earlier one.

    So a patch that is labelled again, after going back, is not taken for new terrain.

    Parameters
    ----------
    places : (n, 2)
        In the order in which they were labelled.
    same_m : float
        A place no farther from an earlier one goes right after the nearest of these, any other one
        to the end.

    Returns
    -------
    (n,)
        Indices of the places.
    """
    order: list[int] = []
    x, y = (places[:, None, axis] - places[:, axis] for axis in (0, 1))
    apart_m = np.sqrt(x * x + y * y)
    apart_m[np.triu_indices(len(places))] = np.inf
    nearest_places = apart_m.argmin(axis=1)
    seen_before = apart_m.min(axis=1) <= same_m
    for place, nearest_place in enumerate(nearest_places.tolist()):
        order.insert(order.index(nearest_place) + 1 if seen_before[place] else place, place)
    return np.array(order, dtype=np.intp)
