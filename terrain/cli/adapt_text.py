"""What `train --adapt` prints of a model for a new camera."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from terrain.classification.adaptation import Adaptation
    from terrain.classification.training import Training


def adapted(patches: Path, model: Path, fixed: dict[str, bool], **settings: Any) -> "Training":
    """Adapt a model and say what of old and new photographs was kept, and why.

    Parameters
    ----------
    patches, model : Path
    fixed : dict of str to bool
        Options that follow from the model, and whether they were given.
    settings : Any
        Of `adapt`.
    """
    from terrain.classification.adaptation import adapt
    from terrain.classification.classifier import TerrainClassifier

    given = [option for option, is_given in fixed.items() if is_given]
    if given:
        raise click.UsageError(f"{given[0]} follows from the model of --adapt: leave it out")
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
            "out to tell whether the old ones help; only the new ones are learned from. The "
            "figures below are of other halves of the same photographs and too good."
        ]
    if found.forgotten:
        lines.append(
            f"Note: {model} knows {', '.join(found.forgotten)}, of which there are no new "
            "photographs: the new model does not know them"
        )
    return "\n".join(lines)
