"""The verb that names the terrain of images, or tests a model on labelled ones."""

import json
import sys
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from terrain.classification.classifier import TerrainClassifier
    from terrain.classification.likeness.likeness import Likeness


@click.command()
@click.argument("model", type=click.Path(path_type=Path))
@click.argument("images", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, with probabilities.")
@click.option(
    "--own-statistics",
    is_flag=True,
    help="Standardise features by all IMAGES: for a camera unlike that of training, and images of "
    "several terrains.",
)
@click.option(
    "--same-camera",
    is_flag=True,
    help="IMAGES are of the camera of training: keep names that are doubted only because MODEL "
    "would not notice another camera.",
)
def classify(
    model: Path,
    images: tuple[Path, ...],
    *,
    as_json: bool,
    own_statistics: bool,
    same_camera: bool,
) -> None:
    """Name the terrain of each of IMAGES with MODEL, a file that `train` wrote.

    Prints label, confidence, and the distance to the nearest class; a label is unknown, without a
    confidence, where the distance is beyond the rejection threshold or the image shows no terrain
    (the reason follows). An image larger than the model's patches is cut
    into patches. An image that cannot be used becomes a row with the reason, and the exit code 1.

    With one folder FOLDER/<terrain>/*.jpg or *.png in place of images: how often each terrain gets
    each label, on those images that the model was not trained on.

    \b
    Example:
      terrain-odometry classify terrain.model photo_1.jpg photo_2.jpg --json
      terrain-odometry classify terrain.model other_photos
    """
    from terrain.classification.classifier import TerrainClassifier
    from terrain.cli.texts.labelled_images import (
        print_held_out,
        print_likeness,
        print_unnamed,
        readable,
    )
    from terrain.errors import ImageError
    from terrain.image_depth import check_depth

    classifier = TerrainClassifier.load(model)
    folders = [path for path in images if path.is_dir()]
    if folders and len(images) > 1:
        raise click.UsageError(f"{folders[0]} is a folder: give one folder alone, or images")
    if own_statistics and same_camera:
        raise click.UsageError("--own-statistics is for another camera, --same-camera is not")
    if same_camera:
        classifier = classifier.on_its_camera()
    if own_statistics:
        classifier = _standardised(classifier, folders[0] if folders else None, images)
    if folders:
        all_used = print_held_out(classifier, model, folders[0], as_json=as_json)
    else:
        check_depth(images, ImageError)
        likeness = classifier.likeness(readable(images))
        rows = [_row(classifier, path, likeness) for path in images]
        print_likeness(likeness, classifier.noticed_share_)
        print_unnamed([row.get("reason", "") for row in rows])
        click.echo(json.dumps(rows, indent=2) if as_json else _table(classifier, rows))
        all_used = not any("error" in row for row in rows)
    if not all_used:
        sys.exit(1)


def _standardised(
    classifier: "TerrainClassifier", folder: Path | None, images: tuple[Path, ...]
) -> "TerrainClassifier":
    """The classifier with the statistics of all images that can be used."""
    from terrain.classification.own_statistics import OwnStatisticsClassifier
    from terrain.classification.photographs.patches import find_photos
    from terrain.errors import ImageError
    from terrain.images import read_image

    own = OwnStatisticsClassifier(classifier)
    for path in images if folder is None else [photo.path for photo in find_photos(folder)]:
        with suppress(ImageError):  # said where it is classified
            own.see(read_image(path))
    click.echo(f"Note: {own.described}", err=True)
    return own.standardised()


def _row(
    classifier: "TerrainClassifier", path: Path, likeness: "Likeness | None"
) -> dict[str, Any]:
    from dataclasses import asdict

    from terrain.errors import ImageError
    from terrain.images import read_image

    try:
        (answer,) = classifier.classify([read_image(path)])
    except ImageError as error:
        return {"image": str(path), "error": str(error)}
    return {"image": str(path)} | asdict(
        answer.unless_doubtful(likeness, classifier.noticed_share_)
    )


def _table(classifier: "TerrainClassifier", rows: list[dict[str, Any]]) -> str:
    from odometry.recording.run import UNKNOWN

    width = max(len(row["image"]) for row in rows)
    names = max(len(name) for name in [*classifier.classes_, "unknown"])
    lines = [f"{'image':{width}}  {'label':{names}}  confidence  distance"]
    for row in rows:
        if "error" in row:
            lines.append(f"{row['image']:{width}}  error: {row['error']}")
        else:
            # of a known terrain, which it is not
            sure = "-" if row["label"] == UNKNOWN else f"{row['confidence']:.2f}"
            lines.append(
                f"{row['image']:{width}}  {row['label']:{names}}  {sure:>10}  "
                f"{row['distance']:8.4g}  {row['reason']}".rstrip()
            )
    lines.append(f"Beyond a distance of {classifier.rejection_distance_:.4g} the label is unknown.")
    return "\n".join(lines)
