"""What `train` prints of a new model, and its picture of probabilities."""

from pathlib import Path

import click
import numpy as np

from odometry.arrays import AnyArray
from odometry.outputs.output_file import picture_source
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.held_out import (
    balanced_accuracy_interval,
    confusion,
    confusion_text,
    photo_votes,
)
from terrain.classification.neighbours.calibration import reliability, reliability_by_chance
from terrain.classification.neighbours.validation import CrossValidation, balanced_accuracy
from terrain.classification.photographs.patches import LabelledPatches
from terrain.cli.outputs import claim_picture


def summary(classifier: TerrainClassifier, patches: LabelledPatches) -> str:
    """Confusion, accuracies, calibration, k and rejection threshold of the cross-validation.

    The interval draws whole groups: what so few photographs leave possible.
    """
    found = classifier.cross_validation_
    answers = found.probabilities.argmax(axis=1)
    names = _photo_names(patches, found)
    true, voted, rows = photo_votes(found.codes, found.probabilities, names)
    groups = np.asarray(patches.scenes)[found.rows[rows]]
    low, high = balanced_accuracy_interval(true, voted, groups, np.random.default_rng(0))
    table = confusion(found.codes, answers, len(classifier.classes_))
    chosen = "given" if classifier.n_neighbors else "chosen"
    return (
        f"{len(patches.photos)} patches of {classifier.patch_size_px} px from {_origin(patches)} "
        "(true terrain down, answer across, %):\n\n"
        f"{confusion_text(table, classifier.classes_.tolist())}\n\n"
        f"balanced accuracy by patch {balanced_accuracy(found.codes, answers):.3f}, by vote of a "
        f"photograph's patches {balanced_accuracy(true, voted):.3f} (95 % interval {low:.3f} to "
        f"{high:.3f}); "
        f"{calibration_words(found, names)}\n"
        f"{chosen} k {classifier.n_neighbors_}, rejection threshold "
        f"{classifier.rejection_distance_:.4g} ({100 * classifier.rejected_share:g} % of known "
        "terrain lies beyond)"
    )


def calibration_words(found: CrossValidation, names: AnyArray) -> str:
    """How far off probabilities are, in which direction, and how much of it chance explains.

    Parameters
    ----------
    found : CrossValidation
        Of n patches.
    names : array, shape (n,)
        Their photographs.
    """
    seen = reliability(found.codes, found.probabilities)
    independent, together = (
        reliability_by_chance(found.probabilities, groups).expected_error
        for groups in (np.arange(len(names)), names)
    )
    if seen.expected_error <= independent:
        judged = "chance explains this"
    elif seen.expected_error <= together:
        judged = "chance may explain this"
    else:
        judged = "chance does not explain this: they are too " + (
            "high" if seen.mean_excess > 0 else "low"
        )
    return (
        f"probabilities are off by {seen.expected_error:.3f} in the mean (expected calibration "
        f"error; exact ones would seem off by {independent:.3f} if patches were independent, by "
        f"{together:.3f} if those of a photograph were right or wrong together: {judged})"
    )


def claim_reliability_picture(picture: Path | None) -> None:
    """Claim the file before any work, if one is wanted."""
    if picture is None:
        return
    if picture.suffix != ".png":
        raise click.UsageError(f"--picture {picture}: expected a name that ends in .png")
    claim_picture(picture)


def write_reliability_picture(
    picture: Path | None, classifier: TerrainClassifier, patches: LabelledPatches
) -> None:
    """Draw the reliability of the cross-validation, where a picture is wanted and it had one."""
    from terrain.report.reliability_figure import write_reliability_figure

    if picture is None:
        return
    if not hasattr(classifier, "cross_validation_"):
        picture.unlink(missing_ok=True)  # that of an earlier call is of another model
        click.echo("Note: no picture is drawn: the old model was kept as it is", err=True)
        return
    found = classifier.cross_validation_
    names = _photo_names(patches, found)
    write_reliability_figure(picture, found, names, source=picture_source("train"))
    click.echo(f"Wrote {picture}")


def _photo_names(patches: LabelledPatches, found: CrossValidation) -> AnyArray:
    """The photograph (n,) of each patch that was held out."""
    return np.array([str(patches.photos[row]) for row in found.rows])


def _origin(patches: LabelledPatches) -> str:
    """How many photographs, and what the cross-validation keeps whole."""
    photos, groups = len(set(patches.photos)), len(set(patches.scenes))
    if groups == photos:
        return f"{photos} photographs, cross-validated by photograph"
    return f"{photos} photographs in {groups} groups, cross-validated by group"
