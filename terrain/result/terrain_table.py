"""The table terrain.csv of a run: an image, or a change of terrain, a row."""

from typing import Any

import numpy as np

from terrain.image_labels.image_label import ImageLabel
from terrain.result.run_result import RunResult, TerrainChange

COLUMNS = ("t", "label", "confidence", "distance_ahead", "terrain_in_force", "reason", "image")


def terrain_columns(result: RunResult) -> dict[str, Any]:
    """Columns of terrain.csv by name; none without a source of terrain.

    With the camera a row is an image. With another source it is a change of the terrain in force,
    the first row the start, and no image is named.
    """
    if result.watcher is not None:
        return _of_images(result.watcher.image_labels, result.watcher.in_force)
    if result.source == "none":
        return {}
    start = TerrainChange(result.replay.terrains[0], float(result.replay.stamps_s[0]))
    changes = (start, *result.changes)
    names = np.array([change.terrain for change in changes])
    unknown, empty = np.full(len(changes), np.nan), np.full(len(changes), "")
    stamps_s = np.array([change.stamp_s for change in changes])
    return dict(zip(COLUMNS, (stamps_s, names, unknown, unknown, names, empty, empty), strict=True))


def _of_images(image_labels: list[ImageLabel], in_force: list[str]) -> dict[str, Any]:
    if not image_labels:
        return {}
    regions = [image_label.region for image_label in image_labels]
    distances = [np.nan if region is None else region.distance_ahead_m for region in regions]
    values = (
        np.array([image_label.stamp_s for image_label in image_labels]),
        np.array([image_label.label for image_label in image_labels]),
        np.array([image_label.confidence for image_label in image_labels]),
        np.array(distances),
        np.array(in_force),
        np.array([image_label.reason for image_label in image_labels]),
        np.array([image_label.image for image_label in image_labels]),
    )
    columns: dict[str, Any] = dict(zip(COLUMNS, values, strict=True))
    if any(image_label.left for image_label in image_labels):
        columns["left"] = np.array([image_label.left for image_label in image_labels])
        columns["right"] = np.array([image_label.right for image_label in image_labels])
    return columns | _numbers(image_labels) | _places(image_labels)


def _places(image_labels: list[ImageLabel]) -> dict[str, Any]:
    """Where the middle of what was classified lay, in the robot frame at the image's stamp [m]."""
    unseen = np.full(2, np.nan)
    places = np.stack([unseen if s.region is None else s.region.place for s in image_labels])
    return {"place_x": places[:, 0], "place_y": places[:, 1]}


def _numbers(image_labels: list[ImageLabel]) -> dict[str, Any]:
    """Results of the classifier beside the label; NaN without one, or with two."""
    names = sorted({name for image_label in image_labels for name in image_label.probabilities})
    of = {
        f"probability_{name}": np.array([s.probabilities.get(name, np.nan) for s in image_labels])
        for name in names
    }
    return {"class_distance": np.array([s.class_distance for s in image_labels])} | of
