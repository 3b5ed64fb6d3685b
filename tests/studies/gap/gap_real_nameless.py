"""Real recordings changed by hand in ways that no effect of the catalogue describes.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.gap.gap_real_nameless [--backward]
        [--out gap_real_nameless] [--only WORD ...]

Each recording is calibrated on its first half and measured on its second one, which is changed;
`--backward` the other way round. `unknown` and `none` are right; `turning` has its name in the
catalogue (`reference_fault`), and is there to see whether it has another one. Every case is a row
of FOLDER/cases.csv.
"""

import argparse
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.ndimage import median_filter

from odometry.arrays import FloatArray
from odometry.recording.run import Run
from tests.studies.gap.gap_real_cases import Case, in_halves, recordings
from tests.studies.gap.gap_real_strong import count

TREADS = ("v_left", "v_right")


def main() -> None:
    """Run the cases, and count their answers."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--backward", action="store_true")
    parser.add_argument("--out", type=Path, default=Path("gap_real_nameless"))
    parser.add_argument("--only", nargs="*", default=[""], help="words in the name of cases")
    arguments = parser.parse_args()
    runs = recordings(Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion")
    count(cases(runs, backward=arguments.backward), arguments.only, arguments.out)


def cases(runs: Mapping[str, Run], *, backward: bool) -> Iterator[Case]:
    """Each recording with each change."""
    for name, run in runs.items():
        first, second = in_halves(run)
        known, measured = (second, first) if backward else (first, second)
        for change in NAMELESS:
            title = f"{change.__name__} {name}"
            yield Case("strong", title, "unknown", [known], [change(measured)])


def receivers(run: Run) -> Run:
    """Two receivers by turns, one half a metre ahead of the other."""
    return _moved_body(run, ahead_m=0.5 * _by_turns(run, 8.0))


def side_receivers(run: Run) -> Run:
    """Two receivers by turns, half a metre beside one another."""
    return _moved_body(run, left_m=0.5 * _by_turns(run, 13.0) - 0.25)


def swing(run: Run) -> Run:
    """A load that swings from side to side, with the antenna on it."""
    return _moved_body(run, left_m=0.15 * np.sin(2 * np.pi * run.pose.stamps_s / 4.3))


def filtered_treads(run: Run) -> Run:
    """The median of tread speeds over a second."""
    rows = max(3, round(1.0 / float(np.median(np.diff(run.odometry.stamps_s)))) | 1)
    speeds = run.odometry.columns
    return _treads(run, {n: median_filter(speeds[n], rows, mode="nearest") for n in TREADS})


def held(run: Run) -> Run:
    """Speeds that are repeated for 0.3 to 1.2 s, about half of the time."""
    rng, stamps_s = np.random.default_rng(5), run.odometry.stamps_s
    last = np.arange(len(stamps_s))
    at_s = stamps_s[0]
    while at_s < stamps_s[-1]:
        until_s = at_s + rng.uniform(0.3, 1.2)
        first, end = np.searchsorted(stamps_s, [at_s, until_s])
        last[first:end] = first
        at_s = until_s + rng.uniform(0.2, 1.0)
    return _treads(run, {name: run.odometry.columns[name][last] for name in TREADS})


def stuck_bit(run: Run) -> Run:
    """A counter of the left wheel one bit of which is always set."""
    speed = run.odometry.columns["v_left"]
    count_m_s = float(np.percentile(np.abs(speed), 95)) / 12
    counts = np.round(np.abs(speed) / count_m_s).astype(int) | 4
    return _treads(run, {"v_left": np.sign(speed) * counts * count_m_s})


def iron(run: Run) -> Run:
    """A compass that is bent near one place."""
    x, y, yaw = (run.pose.columns[name] for name in ("x", "y", "yaw"))
    away_m = np.hypot(x - np.median(x), y - np.median(y))
    reach_m = np.percentile(away_m, 40) + 0.3
    return _pose(run, {"yaw": yaw + 0.35 * np.exp(-((away_m / reach_m) ** 2))})


def third_harmonic(run: Run) -> Run:
    """A yaw that is off three times a turn."""
    yaw = run.pose.columns["yaw"]
    return _pose(run, {"yaw": yaw + 0.2 * np.sin(3 * yaw + 0.7)})


def turning(run: Run) -> Run:
    """A map that turns slowly."""
    angle = 0.004 * (run.pose.stamps_s - run.pose.stamps_s[0])
    x, y, yaw = (run.pose.columns[name] for name in ("x", "y", "yaw"))
    cosine, sine = np.cos(angle), np.sin(angle)
    turned = {"x": cosine * x - sine * y, "y": sine * x + cosine * y, "yaw": yaw + angle}
    return _pose(run, turned)


def late_in_turns(run: Run) -> Run:
    """Positions that lag where the robot turns."""
    stamps_s, columns = run.pose.stamps_s, run.pose.columns
    rate = np.abs(np.gradient(np.unwrap(columns["yaw"]), stamps_s))
    at_s = stamps_s - 0.35 * np.minimum(rate / np.percentile(rate, 90), 1.0)
    return _pose(run, {name: np.interp(at_s, stamps_s, columns[name]) for name in ("x", "y")})


def crossed(run: Run) -> Run:
    """A left wheel that is reported with a share of what the right one is faster."""
    left, right = (run.odometry.columns[name] for name in TREADS)
    more = np.maximum(np.abs(right) - np.abs(left), 0) * np.sign(right)
    return _treads(run, {"v_left": left + 0.25 * more})


def waved(run: Run) -> Run:
    """A right wheel whose scale goes up and down with its speed."""
    speed = run.odometry.columns["v_right"]
    most = float(np.percentile(np.abs(speed), 95))
    return _treads(run, {"v_right": speed * (1 + 0.25 * np.sin(6 * speed / most))})


NAMELESS: tuple[Callable[[Run], Run], ...] = (
    *(receivers, side_receivers, swing, filtered_treads, held, stuck_bit, iron, third_harmonic),
    *(turning, late_in_turns, crossed, waved),
)


def _by_turns(run: Run, span_s: float) -> FloatArray:
    """Zero and one by turns, at every pose."""
    since_s = run.pose.stamps_s - run.pose.stamps_s[0]
    return np.asarray((since_s // span_s) % 2)


def _moved_body(
    run: Run, ahead_m: FloatArray | float = 0.0, left_m: FloatArray | float = 0.0
) -> Run:
    x, y, yaw = (run.pose.columns[name] for name in ("x", "y", "yaw"))
    ahead, left = np.cos(yaw), np.sin(yaw)
    moved = {"x": x + ahead_m * ahead - left_m * left, "y": y + ahead_m * left + left_m * ahead}
    return _pose(run, moved)


def _pose(run: Run, columns: Mapping[str, FloatArray]) -> Run:
    return replace(run, pose=replace(run.pose, columns={**run.pose.columns, **columns}))


def _treads(run: Run, columns: Mapping[str, FloatArray]) -> Run:
    odometry = replace(run.odometry, columns={**run.odometry.columns, **columns})
    return replace(run, odometry=odometry)


if __name__ == "__main__":
    main()
