"""The columns of terrain.csv: what was said of the terrain, and which one was in force."""

from typing import Any

import numpy as np

from terrain.run_result import RunResult
from terrain.sighting import Sighting
from terrain.terrain_change import TerrainChange

SAID = ("t", "label", "confidence", "distance_ahead", "terrain_in_force", "reason", "image")


def terrain_columns(result: RunResult) -> dict[str, Any]:
    """Columns of terrain.csv by name; none where nothing told the terrain.

    With the camera a row is an image. With another source it is a change of the terrain in force,
    the first row the start, and no image stands in it.
    """
    if result.watcher is not None:
        return _of_images(result.watcher.sightings, result.watcher.in_force)
    if result.source == "none":
        return {}
    start = TerrainChange(result.replay.terrains[0], float(result.replay.stamps_s[0]))
    changes = (start, *result.changes)
    names = np.array([change.terrain for change in changes])
    unknown, empty = np.full(len(changes), np.nan), np.full(len(changes), "")
    stamps_s = np.array([change.stamp_s for change in changes])
    return dict(zip(SAID, (stamps_s, names, unknown, unknown, names, empty, empty), strict=True))


def _of_images(sightings: list[Sighting], in_force: list[str]) -> dict[str, Any]:
    if not sightings:
        return {}
    regions = [sighting.region for sighting in sightings]
    distances = [np.nan if region is None else region.distance_ahead_m for region in regions]
    said = (
        np.array([sighting.stamp_s for sighting in sightings]),
        np.array([sighting.label for sighting in sightings]),
        np.array([sighting.confidence for sighting in sightings]),
        np.array(distances),
        np.array(in_force),
        np.array([sighting.reason for sighting in sightings]),
        np.array([sighting.image for sighting in sightings]),
    )
    columns: dict[str, Any] = dict(zip(SAID, said, strict=True))
    if any(sighting.left for sighting in sightings):
        columns["left"] = np.array([sighting.left for sighting in sightings])
        columns["right"] = np.array([sighting.right for sighting in sightings])
    return columns | _numbers(sightings) | _places(sightings)


def _places(sightings: list[Sighting]) -> dict[str, Any]:
    """Where the middle of what was classified lay, in the robot frame at the image's stamp [m]."""
    unseen = np.full(2, np.nan)
    places = np.stack([unseen if s.region is None else s.region.place for s in sightings])
    return {"place_x": places[:, 0], "place_y": places[:, 1]}


def _numbers(sightings: list[Sighting]) -> dict[str, Any]:
    """What the classifier gave beside the label; NaN where it was not asked, or twice."""
    names = sorted({name for sighting in sightings for name in sighting.probabilities})
    of = {
        f"probability_{name}": np.array([s.probabilities.get(name, np.nan) for s in sightings])
        for name in names
    }
    return {"class_distance": np.array([s.class_distance for s in sightings])} | of
