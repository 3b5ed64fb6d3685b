"""What `classify` says of images that are unlike the training photographs."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from odometry.arrays import ByteImage
    from terrain.classification.classifier import TerrainClassifier


def print_likeness(classifier: "TerrainClassifier", paths: Sequence[Path]) -> None:
    """Say so where the images that can be read are unlike, as a whole; nothing else."""
    likeness = classifier.likeness(_readable(paths))
    if likeness is not None and likeness.note is not None:
        click.echo(f"Note: {likeness.note}", err=True)


def _readable(paths: Sequence[Path]) -> Iterator["ByteImage"]:
    from contextlib import suppress

    from terrain.errors import ImageError
    from terrain.images import read_image

    for path in paths:
        with suppress(ImageError):
            yield read_image(path)
