"""How often `identify` notes halves that differ: on recordings as they are, and with a change.

    python -m tests.studies.identification.estimation_halves [--model icr]

Needs TERRAIN_ODOMETRY_DATA. A change is put into the second half of every recording: the difference
of the tread speeds grows, as if the robot were so much wider there. The threshold was chosen on
the recordings that are not among the seven.
"""

import argparse
from dataclasses import replace

import numpy as np

from odometry.errors import OdometryError
from odometry.identification.identify import identify
from odometry.identification.start import SolverConfig
from odometry.recording.run import Run
from tests.studies.main_job.estimation_outputs import with_columns
from tests.studies.main_job.estimation_recordings import SEVEN, motion, recordings

FACTORS = (1.0, 1.1, 1.2, 1.4)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--model", default="icr")
    model = parser.parse_args().model
    noted = {}
    for name in recordings(seven=False):
        run = Run.read(motion() / name)
        cells = []
        for factor in FACTORS:
            halves = halves_in(wider(run, factor), model)
            told = None if halves is None else halves.note() is not None
            noted.setdefault((name in SEVEN, factor), []).append(told)
            cells.append(words(halves, told))
        print(f"{name:42} {' | '.join(cells)}", flush=True)
    for (is_seven, factor), told in noted.items():
        print(f"{'seven' if is_seven else 'others'}, {factor} times as wide: noted "
              f"{told.count(True)} of {len(told)}, not fitted {told.count(None)}")  # fmt: skip


def words(halves, told):
    if halves is None:
        return "not fitted"
    return f"{halves.by_chance:.0e} {halves.worse:.2f}{' noted' if told else ''}"


def wider(run, factor):
    """The run with a larger difference of tread speeds in its second half."""
    t, left, right = run.odometry.stamps_s, run.odometry["v_left"], run.odometry["v_right"]
    half = (right - left) / 2 * np.where(t < (t[0] + t[-1]) / 2, 1.0, factor)
    mean = (left + right) / 2
    return replace(
        run, odometry=with_columns(run.odometry, v_left=mean - half, v_right=mean + half)
    )


def halves_in(run, model):
    try:
        found = identify([run], model, solver_config=SolverConfig(starts=1))
    except OdometryError:
        return None
    return next(iter(found.terrains.values())).halves


if __name__ == "__main__":
    main()
