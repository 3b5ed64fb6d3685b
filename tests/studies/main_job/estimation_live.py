"""The live face of the filter, `IcrEkf.start` and `step`, fed with frames that are odd.

    python -m tests.studies.main_job.estimation_live [--seeds 30]

Of each kind of frame: it must be taken or answered by an error of the project's own; every
estimate must be finite, with a symmetric covariance without negative variances, and the estimate
that went in must not have changed. A frame out of order gives the answer of the frames in order,
or an error. Printed for each kind: how often it was good, refused and bad, the largest distance
from the truth at the end [m], and the first refusal or fault.
"""

import argparse
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from odometry.errors import OdometryError
from odometry.estimation.icr_ekf import IcrEkf
from tests.studies.main_job.estimation_simulation import (
    TRACK_WIDTH_M,
    Noise,
    drive,
    frames_of,
    weave,
)

NOISE = Noise(position=0.01, yaw=0.01, pose_m=0.02, pose_rad=0.01, gyro=0.002)
START = np.array([0.0, 0.0, 0.0, 0.42, -0.38, -0.05, 0.01, 1.0, 1.0])
NAN2, NAN3 = np.full(2, np.nan), np.full(3, np.nan)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=30)
    arguments = parser.parse_args()
    for name, change in KINDS.items():
        answers = [answer(name, change, seed) for seed in range(arguments.seeds)]
        texts = [text for text, _ in answers]
        bad = [text for text in texts if text.startswith("BAD")]
        refused = [text for text in texts if text.startswith("refused")]
        off_m = max((off for _, off in answers), default=np.nan)
        text = (*bad, *refused, "")[0]
        print(f"{name:28} good {len(texts) - len(bad) - len(refused):3} refused {len(refused):3} "
              f"bad {len(bad):3} off {off_m:9.3g} m  {text[:110]}", flush=True)  # fmt: skip


def answer(name, change, seed):
    """What the filter makes of a drive of 20 s whose frames were changed, and how far it is off."""
    rng = np.random.default_rng(seed)
    one = drive(weave(20.0, rng), START, NOISE, rng)
    frames = list(frames_of(one, gyroscope=True))
    try:
        wrong, last = fed(change(frames, rng))
        if not wrong and name in DISORDERED:
            _, in_order = fed(frames)
            difference = np.abs(last.mean - in_order.mean).max()
            wrong = f"{difference:.3g} from the answer in order" if difference > 1e-9 else ""
    except OdometryError as error:
        return f"refused: {error}", np.nan
    except Exception as error:
        return f"BAD: {type(error).__name__}: {error}", np.nan
    off_m = float(np.hypot(*(last.mean[:2] - one.states[-1, :2])))
    return f"BAD: {wrong}" if wrong else "good", off_m


def fed(frames):
    """What is wrong first, "" where nothing is, and the last estimate."""
    ekf = IcrEkf(TRACK_WIDTH_M)
    estimate = ekf.start(frames[0], "ground")
    for frame in frames[1:]:
        mean, covariance = estimate.mean.copy(), estimate.covariance.copy()
        after = ekf.step(estimate, frame, "ground")
        unchanged = (mean == estimate.mean).all() and (covariance == estimate.covariance).all()
        wrong = what_is_wrong(after) if unchanged else "the estimate that went in was changed"
        if wrong:
            return f"{wrong} at {frame.stamp_s:.2f} s", after
        estimate = after
    return "", estimate


def what_is_wrong(estimate):
    mean, covariance = estimate.mean, estimate.covariance
    if not (np.isfinite(mean).all() and np.isfinite(covariance).all()):
        return "not finite"
    if not np.allclose(covariance, covariance.T, rtol=1e-9, atol=1e-12):
        return "covariance not symmetric"
    least = float(np.linalg.eigvalsh(covariance)[0])
    if least < -1e-9 * max(1.0, float(np.trace(covariance))):
        return f"covariance with eigenvalue {least:.3g}"
    if not abs(mean[2]) <= np.pi + 1e-9:
        return f"yaw {mean[2]:.3f} is not wrapped"
    if mean[3] <= 0 or mean[4] >= 0:
        return f"ICRs {mean[3]:.3f}, {mean[4]:.3f} on the wrong side"
    return ""


def every(step, **changes):
    """Every so many frames a field is replaced; a value may be a function of frame and rng."""

    def change(frames, rng):
        return [
            replace(
                f, **{k: v(f, rng) if isinstance(v, Callable) else v for k, v in changes.items()}
            )
            if number % step == step - 1
            else f
            for number, f in enumerate(frames)
        ]

    return change


def silence(**changes):
    """From 5 s on, for good."""
    return lambda frames, rng: [replace(f, **changes) if f.stamp_s > 5 else f for f in frames]  # noqa: ARG005


def swapped(frames, rng):
    row = int(rng.integers(20, len(frames) - 1))
    return [*frames[:row], frames[row + 1], frames[row], *frames[row + 2 :]]


def late_pose(frames, rng):
    """A pose comes 0.3 s after the frames of its time, with its own stamp."""
    rows = [row for row, frame in enumerate(frames[:-10]) if frame.pose is not None]
    row = int(rng.choice(rows[5:]))
    alone = replace(frames[row], tread_speeds_m_s=NAN2, yaw_rate_rad_s=np.nan)
    early = [*frames[:row], replace(frames[row], pose=None), *frames[row + 1 : row + 7]]
    return [*early, alone, *frames[row + 7 :]]


def repeated(frames, rng):
    row = int(rng.integers(20, len(frames)))
    return [*frames[:row], frames[row], *frames[row:]]


def long_gap(length_s):
    def change(frames, rng):
        row = int(rng.integers(50, len(frames)))
        later = [replace(f, stamp_s=f.stamp_s + length_s) for f in frames[row:]]
        return [*frames[:row], *later]

    return change


def _half_pose(frame, rng):
    if frame.pose is None:
        return None
    return np.where(rng.random(3) < 0.5, np.nan, frame.pose)


def _position(frame, rng):  # noqa: ARG001
    return None if frame.pose is None else np.array([*frame.pose[:2], np.nan])


def _yaw(frame, rng):  # noqa: ARG001
    return None if frame.pose is None else np.array([np.nan, np.nan, frame.pose[2]])


def _velocity(frame, rng):
    truth = np.array([frame.tread_speeds_m_s.mean(), 0.0, frame.yaw_rate_rad_s])
    return np.where(rng.random(3) < 0.3, np.nan, truth)


def epoch(frames, rng):  # noqa: ARG001
    return [replace(f, stamp_s=f.stamp_s + 1.7e9) for f in frames]


KINDS = {
    "as it is": lambda frames, rng: frames,  # noqa: ARG005
    "treads NaN now and then": every(7, tread_speeds_m_s=NAN2),
    "one tread NaN": every(7, tread_speeds_m_s=np.array([np.nan, 0.8])),
    "treads NaN for good": silence(tread_speeds_m_s=NAN2),
    "treads NaN from the start": every(1, tread_speeds_m_s=NAN2),
    "pose all NaN": every(5, pose=NAN3),
    "pose half NaN": every(1, pose=_half_pose),
    "pose infinite": every(25, pose=np.array([np.inf, 0.0, 0.0])),
    "pose 1e200": every(25, pose=np.array([1e200, 0.0, 0.0])),
    "pose yaw 1e9": every(25, pose=np.array([1.0, 1.0, 1e9])),
    "positions alone": every(1, pose=_position),
    "yaw alone": every(1, pose=_yaw),
    "no pose at all": every(1, pose=None),
    "gyroscope alone": every(1, pose=None, tread_speeds_m_s=NAN2),
    "gyroscope NaN for good": silence(yaw_rate_rad_s=np.nan),
    "gyroscope infinite": every(30, yaw_rate_rad_s=np.inf),
    "gyroscope 1e6": every(30, yaw_rate_rad_s=1e6),
    "velocity in part": every(3, velocity=_velocity),
    "velocity infinite": every(30, velocity=np.array([np.inf, 0.0, 0.0])),
    "treads infinite": every(30, tread_speeds_m_s=np.array([np.inf, 0.0])),
    "treads 1e9": every(30, tread_speeds_m_s=np.array([1e9, 0.0])),
    "equal stamps": repeated,
    "two frames swapped": swapped,
    "a pose 0.3 s late": late_pose,
    "a stamp NaN": every(101, stamp_s=np.nan),
    "all silent for 10 min": long_gap(600.0),
    "all silent for 1e6 s": long_gap(1e6),
    "stamps since 1970": epoch,
    "in a gap always": every(1, in_gap=True),
    "nothing at all": every(1, pose=None, tread_speeds_m_s=NAN2, yaw_rate_rad_s=np.nan),
}
DISORDERED = ("two frames swapped", "a pose 0.3 s late")


if __name__ == "__main__":
    main()
