"""The modes of a run as files: a table over time, and the numbers that result.json holds."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import AnyArray
from odometry.io.csv_table import write_csv_table
from odometry.io.files import atomic_write
from odometry.modes.follow.detection import Detection, confusion
from odometry.modes.follow.followed import Followed
from odometry.modes.follow.mode_track import ModeTrack
from odometry.modes.models.innovation_test import ModeFit
from odometry.modes.models.mode_set import NO_MODES, NONE_OF_THESE
from odometry.modes.show.doubts import doubts, not_checked
from odometry.modes.show.words import answer_words
from odometry.recording.run import UNKNOWN

NUMBERS = ("median_after_s", "right", "wrong", "undetermined", "wrong_of_all", "none_of_these")
COUNTS = ("stretches", "told", "false_switches")

FORMAT = 1  # of result.json
MEASURED = {"velocity": ("vx", "wz"), "traction": ("x", "y", "yaw", "wz")}


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
    with_camera = out / "modes_with_sight.csv"
    if followed.with_camera is None:
        with_camera.unlink(missing_ok=True)  # of an earlier run
    else:
        seen = {"seen": np.where(followed.seen_labels == UNKNOWN, "", followed.seen_labels)}
        write_csv_table(with_camera, columns_of(followed, followed.with_camera) | seen)
        written.append(with_camera)
    with_feel = out / "modes_with_feel.csv"
    if followed.with_feel is None:
        with_feel.unlink(missing_ok=True)
    else:
        write_csv_table(with_feel, columns_of(followed, followed.with_feel))
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


def content_of(followed: Followed) -> dict[str, Any]:
    """What result.json holds; a number that is not finite is null."""
    mode_set, config = followed.mode_set, followed.config
    with_camera = followed.with_camera
    return {
        "format": FORMAT,
        "program": f"terrain-odometry {version('terrain-odometry')}",
        "run": followed.run.name,
        "kind": mode_set.modes.kind,
        "names": list(mode_set.names),
        "settings": {
            **asdict(config),
            "dwell_s": dict(zip(mode_set.names, mode_set.dwell_s.tolist(), strict=True)),
            "source": mode_set.source,
        },
        "duration_s": float(np.ptp(followed.motion.stamps_s)),
        "not_judged": list(followed.foreign_labels),
        "none_of_these": [
            {
                "from_s": one.from_s,
                "to_s": one.to_s,
                "signal": MEASURED[mode_set.modes.kind][one.signal],
                "sigmas": one.sigmas,
            }
            for one in followed.misfits
        ],
        "not_named": [
            {"reason": one.reason, "remedy": one.remedy, "share": one.share}
            for one in doubts(followed)
        ],
        "not_checked": list(not_checked(followed)),
        "motion": track_content(followed, followed.motion),
        "feel": None if followed.with_feel is None else track_content(followed, followed.with_feel),
        "sight": None if with_camera is None else track_content(followed, with_camera),
        "disagreements": [
            {"from_s": from_s, "to_s": to_s, "seen": seen, "felt": felt}
            for from_s, to_s, seen, felt in followed.disagreements
        ],
        "both_named_s": followed.compared_s if followed.seen else None,
        "none_of_these_while_seen_s": followed.unfit_while_seen[0] if followed.seen else None,
    }


def track_content(followed: Followed, track: ModeTrack) -> dict[str, Any]:
    """Shares, detections and scores of one track."""
    score = followed.score(track)
    squared = track.normalised_squared[np.isfinite(track.normalised_squared)]
    return {
        "shares_of_time": followed.shares(track),
        "undetermined_between": [
            {"modes": list(names), "share": share}
            for names, share in followed.left_open(track).items()
        ],
        "detections": [_detection(one) for one in score.detections],
        "stretches": len(score.detections),
        "told": len(score.detected),
        "median_after_s": _finite(score.median_after_s),
        "right": _finite(score.right),
        "wrong": _finite(score.wrong),
        "undetermined": _finite(score.undetermined),
        "none_of_these": _finite(score.none_of_these),
        "wrong_of_all": _finite(score.wrong_of_all),
        "narrowed_of_all": _finite(score.narrowed_of_all),
        "missed_of_all": _finite(score.missed_of_all),
        "false_switches": score.false_switches,
        "confusion_s": _confusion(followed, track),
        "mean_normalised_innovation_squared": _finite(squared.mean()) if len(squared) else None,
    }


def _detection(one: Detection) -> dict[str, Any]:
    return {
        "mode": one.mode,
        "from_s": one.from_s,
        "to_s": one.to_s,
        "after_s": _finite(one.after_s),
        "right": _finite(one.right),
        "wrong": _finite(one.wrong),
        "undetermined": _finite(one.undetermined),
        "none_of_these": _finite(one.none_of_these),
    }


def _confusion(followed: Followed, track: ModeTrack) -> Mapping[str, Mapping[str, float]]:
    """Seconds by what the run names and answer; modes that it does not name are left out."""
    names = (*followed.mode_set.names, *followed.foreign_labels)
    seconds = confusion(track, followed.config.sure, names)
    return {
        name: dict(zip((*track.names, *NO_MODES), row.tolist(), strict=True))
        for name, row in zip(names, seconds, strict=True)
        if row.any()
    }


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
