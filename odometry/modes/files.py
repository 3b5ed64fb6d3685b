"""The modes of a run as files: a table over time and the numbers."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import AnyArray
from odometry.io.csv_table import write_csv_table
from odometry.io.files import atomic_write
from odometry.modes.content import MEASURED, content_of, track_content
from odometry.modes.followed import Followed
from odometry.modes.innovation_test import ModeFit
from odometry.modes.mode_set import NONE_OF_THESE
from odometry.modes.mode_track import ModeTrack
from odometry.modes.words import answer_words
from odometry.run import UNKNOWN

NUMBERS = ("median_after_s", "right", "wrong", "undetermined", "wrong_of_all", "none_of_these")
COUNTS = ("stretches", "told", "false_switches")


def write_modes(
    followed: Followed, out: Path, about: Mapping[str, Any] | None = None
) -> list[Path]:
    """Write modes.csv and result.json, modes_with_sight.csv and modes_with_feel.csv with these.

    Parameters
    ----------
    followed : Followed
    out : Path
        Made if it is missing; files of an earlier run are replaced one by one.
    about : Mapping, optional
        What made the result; its keys are added to result.json.

    Returns
    -------
    list of Path
        The files written.
    """
    out = Path(out)
    written = [out / "modes.csv", out / "result.json"]
    write_csv_table(written[0], columns_of(followed, followed.motion))
    sighted = out / "modes_with_sight.csv"
    if followed.sighted is None:
        sighted.unlink(missing_ok=True)  # of an earlier run
    else:
        seen = {"seen": np.where(followed.seen_labels == UNKNOWN, "", followed.seen_labels)}
        write_csv_table(sighted, columns_of(followed, followed.sighted) | seen)
        written.append(sighted)
    with_feel = out / "modes_with_feel.csv"
    if followed.felt is None:
        with_feel.unlink(missing_ok=True)
    else:
        write_csv_table(with_feel, columns_of(followed, followed.felt))
        written.append(with_feel)
    text = json.dumps(content_of(followed) | dict(about or {}), indent=2, allow_nan=False)
    with atomic_write(written[1]) as part:
        part.write_text(text + "\n", encoding="utf-8")
    return written


def write_runs(rows: Mapping[str, Followed | str], file: Path) -> Path:
    """Write a table with a row for each run, by name: its scores, or why it failed."""
    columns: dict[str, list[Any]] = {"run": list(rows)}
    columns["failed"] = [row if isinstance(row, str) else "" for row in rows.values()]
    columns["answer"] = [
        "" if isinstance(row, str) else answer_words(row, row.motion) for row in rows.values()
    ]
    tracks = [
        {} if isinstance(row, str) else track_content(row, row.motion) for row in rows.values()
    ]
    for name in NUMBERS:
        values = [track.get(name) for track in tracks]
        columns[name] = [float("nan") if value is None else float(value) for value in values]
    for name in COUNTS:
        columns[name] = [str(track[name]) if track else "" for track in tracks]
    write_csv_table(file, {name: np.array(column) for name, column in columns.items()})
    return file


def columns_of(followed: Followed, track: ModeTrack) -> dict[str, AnyArray]:
    """The columns of modes.csv; `label` is empty where the run names nothing."""
    measured = MEASURED[followed.mode_set.modes.kind]
    states = (*measured, "gyro_bias")
    probabilities = zip(track.names, track.probabilities.T, strict=True)
    return {
        "t": track.stamps_s,
        **{f"probability_{name}": column for name, column in probabilities},
        "answer": followed.answers(track),
        "candidates": followed.candidates(track),
        "label": np.where(track.labels == UNKNOWN, "", track.labels),
        **dict(zip(states, track.means.T, strict=True)),
        **{f"sigma_{name}": column for name, column in zip(states, track.sigmas.T, strict=True)},
        **({} if track.fit is None else _fit_columns(track.fit, measured)),
        **_between_columns(track),
        **_feel_columns(track),
    }


def _between_columns(track: ModeTrack) -> dict[str, AnyArray]:
    """Between which two modes the robot turns where that is the answer, and how far."""
    if track.between is None:
        return {}
    words = np.array(["", *(" and ".join(pair) for pair in track.between.pairs)], dtype=object)
    return {"between": words[track.between.place + 1], "between_share": track.between.share}


def _feel_columns(track: ModeTrack) -> dict[str, AnyArray]:
    """The probability of each mode by feel alone."""
    if track.felt is None:
        return {}
    return {f"feel_{name}": of for name, of in zip(track.names, track.felt.T, strict=True)}


def _fit_columns(fit: ModeFit, measured: Sequence[str]) -> dict[str, AnyArray]:
    """The probability that no mode fits; what is left of each entry, in standard deviations."""
    left = {f"innovation_{name}": of for name, of in zip(measured, fit.best.T, strict=True)}
    return {f"probability_{NONE_OF_THESE}": fit.none, **left}
