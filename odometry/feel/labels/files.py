"""Terrain by feel of a run as sentences and as files."""

import json
from collections.abc import Iterator, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import AnyArray
from odometry.feel.assessment.scores import balanced_accuracy
from odometry.feel.labels.felt import NOT_MEASURED, SILENT, STATIONARY
from odometry.feel.labels.follow import Felt
from odometry.io.csv_table import write_csv_table
from odometry.io.files import atomic_write
from odometry.recording.run import UNKNOWN

UNLIKE_SHARE = 0.5  # of the windows: a run with more that are unknown is unlike those of the model
OFTEN = 0.05  # share of the windows from which a sentence is written


def sentences(felt: Felt) -> tuple[str, ...]:
    """The answer for the run, then what is to be known of it."""
    return (answer_words(felt), *_more(felt))


def shares(felt: Felt) -> dict[str, float]:
    """Share of the windows of each answer over the last stretch, the largest first."""
    names, counts = np.unique(felt.lasting_answers.astype(str), return_counts=True)
    found = dict(zip(names.tolist(), (counts / counts.sum()).tolist(), strict=True))
    return dict(sorted(found.items(), key=lambda one: -one[1]))


def answer_words(felt: Felt) -> str:
    """Which share of the time feels like what."""
    said = ", ".join(f"{name} {100 * share:.0f} %" for name, share in shares(felt).items())
    return f"Answers, by their share of the time: {said}."


def is_unlike(felt: Felt) -> bool:
    """Whether most of the windows in which the robot moves are like no terrain of the model."""
    moving = felt.windows.felt
    return bool(moving.any() and (felt.answers[moving] == UNKNOWN).mean() > UNLIKE_SHARE)


def doubts(felt: Felt) -> tuple[str, ...]:
    """Sentences of what makes any answer doubtful."""
    return (*_of_vibration(felt), *_of_model(felt))


def _of_vibration(felt: Felt) -> Iterator[str]:
    """Where it is unlike that of the model."""
    moving = felt.windows.felt
    if moving.any() and felt.foreign[-1]:
        how = felt.model.shape_so_far.plus(felt.windows).words
        yield (
            f"{how}, or tyres or a terrain that shake the robot unlike all of them. Unknown; "
            "identify a model with this IMU."
        )
    if is_unlike(felt):
        share = (felt.answers[moving] == UNKNOWN).mean()
        farthest = ", ".join(felt.model.farthest_columns(felt.windows))
        yield (
            f"{100 * share:.0f} % of the windows feel like nothing that the model was identified "
            f"from; the farthest off are {farthest}: another terrain, load, tyre or sensor?"
        )


def _more(felt: Felt) -> Iterator[str]:
    moving = felt.windows.felt
    if not moving.any():
        yield "The robot stands, or nothing was measured, all the time: nothing can be felt."
        return
    probabilities, _ = felt.of_run
    best = max(probabilities, key=lambda name: probabilities[name])
    yield from _of_vibration(felt)
    is_one = set(felt.lasting_answers.tolist()) <= {best, UNKNOWN, *SILENT}
    if is_one and not is_unlike(felt) and felt.answer_of_run[0] != UNKNOWN:
        yield f"If it is all one terrain, it is {best} with probability {probabilities[best]:.2f}."
    outside = felt.outside_speeds[moving].mean()
    if outside > OFTEN:
        limits = felt.model.limits
        yield (
            f"{100 * outside:.0f} % of the windows are driven at speeds that the model does not "
            f"know ({limits.slowest_m_s:.2f} to {limits.fastest_m_s:.2f} m/s): unknown."
        )
    silent = {
        STATIONARY: "the robot stands",
        NOT_MEASURED: "samples are missing, or the gyroscope turns while the treads stand",
    }
    for name, word in silent.items():
        share = (felt.answers == name).mean()
        if share > OFTEN:
            yield f"In {100 * share:.0f} % of the windows {word}."
    yield from _of_model(felt)


def _of_model(felt: Felt) -> Iterator[str]:
    """What makes any answer of the model doubtful."""
    if felt.model.members.logistic is None:
        yield (
            "The model is of an older version, which hardly distinguishes terrains that it does "
            "not know: identify it again."
        )
    if names := felt.model.report.get("one_drive"):
        yield (
            f"The model felt {', '.join(names)} on one drive each: how another drive feels is not "
            "known, and probabilities are too large."
        )
    robot = felt.run.robot.name
    if robot and felt.model.robot and robot != felt.model.robot:
        yield f"The model is of {felt.model.robot!r}, the run of {robot!r}: be wary of the answers."


FORMAT = 1  # of result.json


def write_feel(felt: Felt, out: Path, about: Mapping[str, Any] | None = None) -> list[Path]:
    """Write feel.csv and result.json.

    Parameters
    ----------
    felt : Felt
    out : Path
        Made if it is missing.
    about : Mapping, optional
        What made the result; its keys are added to result.json.

    Returns
    -------
    list of Path
        The files written.
    """
    written = [Path(out) / "feel.csv", Path(out) / "result.json"]
    write_csv_table(written[0], columns_of(felt))
    text = json.dumps(content_of(felt) | dict(about or {}), indent=2, allow_nan=False)
    with atomic_write(written[1]) as part:
        part.write_text(text + "\n", encoding="utf-8")
    return written


def write_feel_runs(rows: Mapping[str, Felt | str], terrains: Sequence[str], file: Path) -> None:
    """Write one row a run, by name: the answer for all of it, or why it failed.

    Parameters
    ----------
    rows : Mapping
        By the name of each run, what it feels like, or why that is not known.
    terrains : sequence of str
        Those of the model.
    file : Path
    """
    felt = [None if isinstance(row, str) else row for row in rows.values()]
    answers = [("", np.nan, np.nan) if one is None else one.answer_of_run for one in felt]
    columns = {
        "run": np.array(list(rows)),
        "label": np.array([label for label, _, _ in answers]),
        "probability": np.array([probability for _, probability, _ in answers]),
        "probability_unknown": np.array([unknown for _, _, unknown in answers]),
        "windows": np.array([0 if one is None else int(one.windows.felt.sum()) for one in felt]),
        "true_label": np.array(["" if one is None else one.run.terrain or "" for one in felt]),
    }
    for name in (*terrains, UNKNOWN):
        of_runs = [np.nan if one is None else shares(one).get(name, 0.0) for one in felt]
        columns[f"share_{name}"] = np.array(of_runs)
    columns["failed"] = np.array([row if isinstance(row, str) else "" for row in rows.values()])
    write_csv_table(file, columns)


def columns_of(felt: Felt) -> dict[str, AnyArray]:
    """The columns of feel.csv; `t` is the end of each window, when it is known."""
    names = felt.model.names
    return {
        "t": felt.stamps_s,
        "label": felt.lasting_answers,
        **_named("probability", names, felt.lasting_probabilities),
        "probability_unknown": felt.lasting_unknown,
        "window_label": felt.answers,
        **_named("window_probability", names, felt.probabilities),
        "window_probability_unknown": felt.unknown,
        "novelty": felt.model.limits.excess(
            np.ones(len(felt.windows)), felt.scores.novelty, felt.scores.offsets
        ),
        "speed": felt.windows.speeds_m_s,
        "true_label": np.where(felt.windows.labels == UNKNOWN, "", felt.windows.labels),
    }


def content_of(felt: Felt) -> dict[str, Any]:
    """What result.json holds."""
    probabilities, _ = felt.of_run
    return {
        "format": FORMAT,
        "program": f"terrain-odometry {version('terrain-odometry')}",
        "run": felt.run.name,
        "names": list(felt.model.names),
        "settings": {
            "window_s": felt.model.design.window_s,
            "stretch_s": felt.config.stretch_s,
            "sure": felt.config.sure,
            "unknown_share": felt.config.unknown_share or felt.model.strangeness.share,
            "columns": list(felt.model.design.columns),
            "source": felt.model.source,
        },
        "windows": len(felt.windows),
        "shares_of_windows": shares(felt),
        "run_probabilities": probabilities,
        "run_is_unknown": felt.answer_of_run[0] == UNKNOWN or is_unlike(felt),
        "balanced_accuracy": _accuracy(felt),
        "notes": list(sentences(felt)[1:]),
    }


def _accuracy(felt: Felt) -> dict[str, float] | None:
    """Where the run names terrains of the model: shares of windows in which the robot moves."""
    labels = felt.windows.labels
    judged = felt.windows.felt & np.isin(labels.astype(str), felt.model.names)
    if not judged.any():
        return None
    return {
        name: balanced_accuracy(labels[judged], answers[judged] == labels[judged])
        for name, answers in (("window", felt.answers), ("stretch", felt.lasting_answers))
    }


def _named(word: str, names: tuple[str, ...], values: AnyArray) -> dict[str, AnyArray]:
    return {f"{word}_{name}": column for name, column in zip(names, values.T, strict=True)}
