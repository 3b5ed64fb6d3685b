"""Runs that do not feel like the terrain that they name, to a model of the others."""

from collections.abc import Iterator, Sequence

from odometry.feel.assessment.assessment import Assessment

LEAST_OWN = 0.1  # probability of the named terrain by the whole run, held out
MOST_NOTES = 3


def notes_of_doubted(found: Assessment, run_names: Sequence[str]) -> Iterator[str]:
    """Sentences of such runs, the most certain first; names of the runs (R,) that were assessed."""
    answers = found.by_length["run"]
    rows = zip(
        answers.labels.tolist(), answers.runs.tolist(), answers.probabilities.tolist(), strict=True
    )
    doubted = []
    for named, run, probabilities in rows:
        of = dict(zip(found.names, probabilities, strict=True))
        likely = max(of, key=lambda name: of[name])
        if of[named] < LEAST_OWN:
            doubted.append((of[likely], run, named, likely, of[named]))
    doubted.sort(reverse=True)
    for probability, run, named, likely, own in doubted[:MOST_NOTES]:
        yield (
            f"{run_names[run]}, named {named}, feels like {likely} ({probability:.2f}, {named} "
            f"{own:.2f}) to a model of the other runs: is its terrain named rightly, and were "
            "tyres, load and weather those of the others?"
        )
    if len(doubted) > MOST_NOTES:
        yield f"Further runs of which the same is true: {len(doubted) - MOST_NOTES}."
