"""What `LiveOdometry.notes` says of recordings with another unit, sign or order of a column.

    python -m tests.studies.recordings.live_notes held
        # or dev: every second recording by name

Needs the recordings of `TERRAIN_ODOMETRY_DATA`. A minute of each is fed frame by frame, without
its poses and with them. Printed: in how many recordings the note of a motion that no robot has
stands at the end, and at any frame.
"""

import argparse
import os
from dataclasses import replace
from pathlib import Path

import numpy as np

import odometry
import terrain

LASTS_S = {False: 60.0, True: 45.0}  # by whether poses are used


def scaled(factor):
    return lambda frame: replace(frame, tread_speeds_m_s=factor * frame.tread_speeds_m_s)


def turned(factor):
    return lambda frame: replace(frame, yaw_rate_rad_s=factor * frame.yaw_rate_rad_s)


CHANGES = {
    "as it is": lambda frame: frame,
    "treads in rad/s": scaled(1 / 0.15),
    "treads in mm/s": scaled(1000.0),
    "treads in km/h": scaled(3.6),
    "gyroscope in degrees": turned(180 / np.pi),
    "gyroscope reversed": turned(-1.0),
    "treads exchanged": lambda f: replace(f, tread_speeds_m_s=f.tread_speeds_m_s[::-1]),
}
WITH_POSES = ("as it is", "treads in rad/s", "gyroscope reversed")


def recordings(half):
    """Folders of half of the recordings, every second one by name."""
    root = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion"
    folders = sorted(file.parent for file in root.glob("*/run.toml"))
    return folders[half == "held" :: 2]


def notes(run, change, *, with_poses):
    """Whether the note stands at each frame."""
    live = terrain.LiveOdometry(run.robot, at_pose=with_poses and run.pose is not None)
    found, begin_s = [], None
    for frame in run.frames():
        begin_s = frame.stamp_s if begin_s is None else begin_s
        if frame.stamp_s - begin_s > LASTS_S[with_poses]:
            break
        step = live.step(change(frame if with_poses else replace(frame, pose=None)))
        if step is not None:
            found.append(any("are usual" in note for note in live.notes))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("half", choices=["dev", "held"])
    folders = recordings(parser.parse_args().half)
    for with_poses in (False, True):
        for name in WITH_POSES if with_poses else CHANGES:
            found = {
                folder.name: notes(odometry.Run.read(folder), CHANGES[name], with_poses=with_poses)
                for folder in folders
            }
            last = sum(one[-1] for one in found.values())
            ever = [folder for folder, one in found.items() if any(one)]
            said = f": {', '.join(ever)}" if name == "as it is" and ever else ""
            poses = "with poses" if with_poses else "without poses"
            print(f"{poses}, {name}: at the end {last}, ever {len(ever)} of {len(found)}{said}")


if __name__ == "__main__":
    main()
