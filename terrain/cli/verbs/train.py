"""The verb that trains a terrain classifier from labelled photographs."""

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from terrain.cli.options import (
    OUTPUT,
    Positive,
    network_options,
    processes_option,
    scheduler_option,
)

if TYPE_CHECKING:
    from terrain.classification.adaptation import Adaptation
    from terrain.classification.features.network_features import NetworkFeatures
    from terrain.classification.training import Training


@click.command()
@click.argument("patches", type=click.Path(path_type=Path))
@click.option(
    "--out",
    metavar="MODEL",
    type=OUTPUT,
    required=True,
    help="The model file.",
)
@click.option(
    "--preset",
    type=click.Choice(["default", "fast", "chen2023"]),
    default="default",
    show_default=True,
    help="fast uses SFTA of four filtered copies alone, and one patch of an image in a run, for "
    "small computers; chen2023 is the paper's classifier.",
)
@click.option(
    "--patch-size",
    type=click.IntRange(min=8),
    metavar="PX",
    help="Side of a patch.  [default: 128, or what fits into nine of ten photographs]",
)
@click.option(
    "--metres-per-pixel",
    type=Positive(1000.0),
    help="Scale of the photographs on the terrain; kept in the model.  [default: as manifest.csv "
    "states it]",
)
@click.option(
    "--k",
    type=click.IntRange(min=1),
    help="Neighbours that vote.  [default: best in cross-validation]",
)
@click.option(
    "--reject",
    type=click.FloatRange(0, 1, min_open=True, max_open=True),
    default=0.05,
    show_default=True,
    metavar="SHARE",
    help="Share of known patches that may be called unknown; a larger share also refuses more of "
    "what was not in training.",
)
@click.option("--colour", is_flag=True, help="Use colour: for one camera in training and in use.")
@network_options
@click.option(
    "--augment",
    is_flag=True,
    help="Learn from altered copies of the photographs as well, as another camera or light would "
    "show them: more names are right with another camera, and fewer wrong ones refused.",
)
@click.option(
    "--adapt",
    "old",
    type=click.Path(path_type=Path),
    metavar="MODEL",
    help="PATCHES are a few photographs of a new camera: mix them with what MODEL learned from, "
    "where cross-validation says that it helps.",
)
@click.option(
    "--picture",
    metavar="FILE.png",
    type=OUTPUT,
    help="Draw the reliability diagram of cross-validation: how often answers of each probability "
    "were right.",
)
@processes_option
@scheduler_option
def train(
    *,
    patches: Path,
    out: Path,
    preset: str,
    patch_size: int | None,
    metres_per_pixel: float | None,
    colour: bool,
    features: "NetworkFeatures | None",
    k: int | None,
    reject: float,
    augment: bool,
    old: Path | None,
    picture: Path | None,
    processes: int | None,
    scheduler: str | None,
) -> None:
    """Train a terrain classifier on PATCHES/<terrain>/*.jpg or *.png.

    Photographs are cut to patches of one size, overlapping by half, at most 60 a photograph.
    Those that share a photo_id in manifest.csv (in PATCHES or beside it) are held out together
    in cross-validation.

    \b
    Example:
      terrain-odometry train my_photos --out terrain.model --metres-per-pixel 0.002
      terrain-odometry train my_photos --out terrain.model --features network.onnx
      terrain-odometry train my_photos --out terrain.model --scheduler tcp://host:8786
      terrain-odometry train new_camera --out new.model --adapt terrain.model
    """
    from terrain.classification.model_file import is_model
    from terrain.classification.training import train as train_classifier
    from terrain.cli.outputs import WHOLE, claim_file
    from terrain.cli.texts.train_notes import notes
    from terrain.cli.texts.train_text import (
        claim_reliability_picture,
        summary,
        write_reliability_picture,
    )

    made = claim_file(out, is_model)
    claim_reliability_picture(picture)
    shared: dict[str, Any] = {
        "metres_per_pixel": metres_per_pixel,
        "colour": colour,
        "rejected_share": reject,
        "processes": processes or -1,
        "show_progress": True,
    }
    if old is None:
        training = train_classifier(
            patches,
            preset=preset,
            patch_size_px=patch_size,
            features=features,
            k=k,
            augment=augment,
            scheduler=scheduler,
            **shared,
        )
    else:
        unused = {
            "--preset": preset != "default",
            "--patch-size": patch_size is not None,
            "--features": features is not None,
            "--k": k is not None,
            "--augment": augment,
            "--scheduler": scheduler is not None,
        }
        training = adapted(patches, old, unused, **shared)
    classifier, loaded = training.classifier, training.patches
    chooses_size = patch_size is None and old is None
    for note in notes(training, patches, colour=colour, chooses_size=chooses_size):
        click.echo(note, err=True)
    if features is not None:
        click.echo(
            f"Features: {features.described}. The model holds this part of the network.", err=True
        )
    classifier.save(out, made.to_table())
    WHOLE.append(out)
    if hasattr(classifier, "cross_validation_"):  # a model that was kept as it is has none
        click.echo(summary(classifier, loaded))
    write_reliability_picture(picture, classifier, loaded)
    click.echo(f"\nWrote {out}. Next: terrain-odometry classify {shlex.quote(str(out))} IMAGE...")


def adapted(patches: Path, model: Path, unused: dict[str, bool], **settings: Any) -> "Training":
    """Adapt a model and say what of old and new photographs was kept, and why.

    Parameters
    ----------
    patches, model : Path
    unused : dict of str to bool
        Options that follow from the model or do nothing with it, and whether they were given.
    settings : Any
        Of `adapt`.
    """
    from terrain.classification.adaptation import adapt
    from terrain.classification.classifier import TerrainClassifier

    given = [option for option, is_given in unused.items() if is_given]
    if given:
        raise click.UsageError(f"{given[0]} does nothing with --adapt: leave it out")
    found = adapt(patches, TerrainClassifier.load(model), **settings)
    click.echo(_words(found, model), err=True)
    return found.training


def _words(found: "Adaptation", model: Path) -> str:
    if found.scores:
        scores = ", ".join(f"{name} {score:.3f}" for name, score in found.scores.items())
        lines = [
            f"Adapted from {model}: balanced accuracy by patch on new photographs that were held "
            f"out: {scores}. Kept: {found.kept}; another way is kept only where it is better than "
            "the new photographs alone by more than twice the standard error of the difference."
        ]
    else:
        lines = [
            f"Adapted from {model}: a terrain has one photograph alone, so that none can be held "
            "out to show whether the old ones help; only the new ones are learned from. The "
            "figures below are of other halves of the same photographs and too good."
        ]
    if found.forgotten:
        lines.append(
            f"Note: {model} knows {', '.join(found.forgotten)}, of which there are no new "
            "photographs: the new model does not know them"
        )
    return "\n".join(lines)
