"""The search of odometry/gap/solve.py against SciPy's on fits of the gap workflow.

    python -m tests.studies.gap.gap_solvers [--kinds KIND ...] [--seed 31] [--out gap_solvers.csv]

Each search for values from a start, as it comes up in blind cases, is made by all: with the same
derivatives, bounds and scales, SciPy's ending where a step gains a ten-thousandth of the cost or
0.1. The workflow goes on with ours. `lm` takes no bounds: a fit that left them is a failure.
"""

import argparse
import csv
import tempfile
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import scipy.optimize

from odometry.gap.fit import hypothesis as gap_fit
from odometry.gap.gap import find_gap
from odometry.gap.solve import Found, differences, least_squares
from odometry.recording.run import Run
from tests.blind.cases import make_case

KINDS = ("wheel_scale+time_offset", "actuator_lag", "top_speed", "curvature", "lever_arm")
METHODS = ("trf", "dogbox", "lm")
LEAST_GAIN, LEAST_SHARE, MOST_TIMES = 0.1, 1e-4, 4
CLOSE = 1.0  # of chi-squared


def main() -> None:
    """Record every fit of the cases and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kinds", nargs="*", default=KINDS)
    parser.add_argument("--seed", type=int, default=31)
    parser.add_argument("--out", type=Path, default=Path("gap_solvers.csv"))
    arguments = parser.parse_args()
    with arguments.out.open("w", newline="", encoding="utf-8") as stream:
        sheet = csv.writer(stream)
        sheet.writerow(["kind", "fit", "solver", "evaluations", "seconds", "chi_squared"])
        fits: list[dict[str, tuple[int, float, float]]] = []
        for kind in arguments.kinds:
            gap_fit.least_squares = beside(fits)
            known = len(fits)
            with tempfile.TemporaryDirectory() as folder:
                case = make_case(kind, arguments.seed, Path(folder))
                runs = [Run.read(one) for one in (case.measured, case.calibration, case.holdout)]
                find_gap(runs[:1], runs[1:2], runs[2:])
            for place in range(known, len(fits)):
                sheet.writerows([kind, place, name, *row] for name, row in fits[place].items())
            stream.flush()
    print_table(fits)


def beside(fits: list[dict[str, tuple[int, float, float]]]) -> Callable[..., Found]:
    """Ours, which appends what each solver took and reached to `fits`."""

    def search(rows_at, start, scales, bounds, iterations, *, derivative) -> Found:  # type: ignore[no-untyped-def]
        if iterations < gap_fit.ITERATIONS or not (bounds[0] < bounds[1]).any():
            return least_squares(rows_at, start, scales, bounds, iterations, derivative=derivative)
        problem = rows_at, start, scales, bounds, iterations
        found, *row = timed(least_squares, *problem)
        results = {"ours": (*row, found.cost)}
        for method in METHODS:
            cost, *row = timed(partial(by_scipy, method=method), *problem)
            results[method] = (*row, cost)
        fits.append(results)
        return found

    return search


def timed(solve: Callable[..., Any], rows_at: Callable[..., Any], *rest: Any) -> tuple[Any, ...]:
    """What a solver finds, how many evaluations it took, and how long [s]."""
    count = 0

    def counted(values: np.ndarray) -> np.ndarray:
        nonlocal count
        count += 1
        return np.asarray(rows_at(values))

    begin = time.process_time()
    found = solve(counted, *rest)
    return found, count, time.process_time() - begin


def by_scipy(rows_at, start, scales, bounds, iterations, *, method) -> float:  # type: ignore[no-untyped-def]
    """Chi-squared that SciPy reaches; NaN where it leaves the bounds or has too few rows."""
    low, high = bounds
    begin = np.clip(start, low, high)
    free = low < high
    remembered: dict[bytes, np.ndarray] = {}

    def whole(part: np.ndarray) -> np.ndarray:
        values = begin.copy()
        values[free] = part
        return values

    def rows(part: np.ndarray) -> np.ndarray:
        remembered.clear()
        return remembered.setdefault(part.tobytes(), rows_at(whole(part)))

    def derivative(part: np.ndarray) -> np.ndarray:
        at = remembered.get(part.tobytes())
        at = rows(part) if at is None else at
        return differences(rows_at, whole(part), at, scales, bounds)[:, free]

    first = rows(begin[free])
    found = scipy.optimize.least_squares(
        rows,
        begin[free],
        jac=derivative,
        method=method,
        bounds=(-np.inf, np.inf) if method == "lm" else (low[free], high[free]),
        x_scale=scales[free],
        ftol=max(LEAST_SHARE, LEAST_GAIN / max(float(first @ first), 1.0)),
        xtol=1e-6,
        max_nfev=MOST_TIMES * iterations,
    )
    inside = np.all((found.x >= low[free]) & (found.x <= high[free]))
    return 2 * float(found.cost) if inside else float("nan")


def print_table(fits: Sequence[dict[str, tuple[int, float, float]]]) -> None:
    """By solver: evaluations and time, and how often it is close to the least of all."""
    table = np.array([list(results.values()) for results in fits])
    least = np.nanmin(table[:, :, 2], axis=1, keepdims=True)
    close = (table[:, :, 2] <= least + CLOSE).mean(axis=0)
    print(f"{len(fits)} fits")
    for place, name in enumerate(("ours", *METHODS)):
        evaluations, seconds = table[:, place, :2].sum(axis=0) / table[:, 0, :2].sum(axis=0)
        print(
            f"{name:7} evaluations {evaluations:.2f}, time {seconds:.2f} of ours; within {CLOSE:g} "
            f"of the least chi-squared {close[place]:.1%}, failed "
            f"{np.isnan(table[:, place, 2]).mean():.1%}"
        )


if __name__ == "__main__":
    main()
