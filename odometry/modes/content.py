"""The modes of a run as numbers: what result.json holds."""

from collections.abc import Mapping
from dataclasses import asdict
from importlib.metadata import version
from typing import Any

import numpy as np

from odometry.modes.detection import Detection, confusion
from odometry.modes.doubts import doubts
from odometry.modes.followed import Followed
from odometry.modes.mode_set import NO_MODES
from odometry.modes.mode_track import ModeTrack
from odometry.modes.not_checked import not_checked

FORMAT = 1  # of result.json
MEASURED = {"velocity": ("vx", "wz"), "traction": ("x", "y", "yaw", "wz")}


def content_of(followed: Followed) -> dict[str, Any]:
    """What result.json holds; a number that is not finite is null."""
    mode_set, config = followed.mode_set, followed.config
    sighted = followed.sighted
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
        "feel": None if followed.felt is None else track_content(followed, followed.felt),
        "sight": None if sighted is None else track_content(followed, sighted),
        "disagreements": [
            {"from_s": from_s, "to_s": to_s, "seen": seen, "felt": felt}
            for from_s, to_s, seen, felt in followed.disagreements
        ],
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
        "told": len(score.told),
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
