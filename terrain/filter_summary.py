"""What the filter made of its measurements, and what it noticed of its sensors."""

from typing import Any

import numpy as np

from odometry.estimates import Replay
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.filter_start import INITIAL_YAW, LATER_YAW
from odometry.estimation.transition import GYRO_BIAS
from odometry.run_end import DRIFT_FOLLOWED

HARMLESS = {  # kinds of events after which the estimate is still valid
    DRIFT_FOLLOWED,
    INITIAL_YAW,
    LATER_YAW,
    "gyroscope_bias",
    "gyroscope_bias_changed",
    "gyroscope_held",
    "gyroscope_silence",
    "gyroscope_spike",
    "late_poses",
    "odometry_gap",
    "pose_outage",
    "refused_poses",
    "tread_spike",
}


def filter_table(replay: Replay) -> dict[str, Any]:
    """What result.json holds of the filter: plain values, units in the names."""
    squared = replay.innovations_squared
    squared = squared[~np.isnan(squared)]
    last = replay.estimates[-1]
    yaw = next((event.values for event in replay.events if event.kind == INITIAL_YAW), None)
    return {
        "poses": len(squared),
        "poses_refused": len(squared) - int(replay.accepted.sum()),
        "median_normalised_innovation_squared": float(np.median(squared)) if len(squared) else None,
        "jumps_s": replay.stamps_s[replay.jumps].tolist(),
        "gyro_bias_rad_s": float(last.mean[GYRO_BIAS]) if replay.used_gyroscope else None,
        "sigma_gyro_bias_rad_s": (
            float(replay.sigmas[-1, GYRO_BIAS]) if replay.used_gyroscope else None
        ),
        "initial_yaw": None if yaw is None else {"yaw_rad": yaw[0], "sigma_rad": yaw[1]},
        "events": [
            {
                "kind": event.kind,
                "begin_s": event.begin_s,
                "end_s": event.end_s,
                "text": event.text,
            }
            for event in replay.events
        ],
    }


def misleading(replay: Replay) -> list[FilterEvent]:
    """Events that show that the run misled the filter: its estimates are then in doubt."""
    return [event for event in replay.events if event.kind not in HARMLESS]


def event_line(event: FilterEvent, began_s: float) -> str:
    """When, in seconds since a stamp, and what, in one line."""
    begin_s, end_s = event.begin_s - began_s, event.end_s - began_s
    if end_s > begin_s:
        return f"{begin_s:.1f} to {end_s:.1f} s: {event.text}"
    return f"{begin_s:.1f} s: {event.text}"
