"""How often 95 % intervals from positions without yaw hold the truth.

    python -m tests.studies.identification.coverage_positions [--seeds 200] [--model icr]
        [--wander 0.05]
        [--lasting 20]

The drives are those of `coverage.py`, their yaw left out; every second one has a gyroscope.
`--wander` adds slip that the model does not have (relative size, over about 3 s); `--lasting`
makes the noise of positions last so many seconds, as that of GNSS is. The length of
the stretches is chosen as `identify` chooses it.
"""

import argparse
import time
from dataclasses import replace

import numpy as np

from odometry.errors import OdometryError
from odometry.identification.fitters import fitter
from odometry.identification.plausibility import refusals
from odometry.identification.start import SolverConfig
from odometry.identification.stretch_fit import stretches_for
from odometry.models.catalogue import MODELS
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from tests.studies.identification.coverage import TRUTHS, Cell, drive

DURATIONS_S = (60.0, 300.0)
POSITION_HZ = (1.0, 5.0, 10.0)
NOISE_M = (0.02, 0.3)


def noise_of(stamps_s: np.ndarray, lasting_s: float, rng: np.random.Generator) -> np.ndarray:
    """Noise (M,) of unit variance, correlated over so many seconds (Gauss and Markov)."""
    noise = rng.standard_normal(len(stamps_s))
    if lasting_s > 0:
        kept = np.exp(-np.diff(stamps_s) / lasting_s)
        for i, share in enumerate(kept, start=1):
            noise[i] = share * noise[i - 1] + np.sqrt(1 - share**2) * noise[i]
    return noise


def positions_of(cell: Cell, seed: int, noise_m: float, lasting_s: float) -> Run:
    """A drive of `coverage.py` without yaw, with noise added to its positions."""
    run = drive(cell, seed, 0)
    rng = np.random.default_rng([seed, 77])
    columns = dict(run.pose.columns)
    for name in ("x", "y"):
        columns[name] = columns[name] + noise_m * noise_of(run.pose.stamps_s, lasting_s, rng)
    columns["yaw"] = np.full(len(run.pose), np.nan)
    return replace(run, pose=replace(run.pose, columns=columns))


def intervals_of(
    cell: Cell, seed: int, noise_m: float, lasting_s: float
) -> dict[str, tuple[float, float]] | None:
    """95 % intervals by parameter; None where the runs are refused."""
    run, config = positions_of(cell, seed, noise_m, lasting_s), WindowConfig()
    try:
        fit = fitter(
            MODELS[cell.model],
            run.robot,
            fixed={},
            window_config=config,
            solver_config=SolverConfig(starts=2),
        )(stretches_for([run], config))
    except OdometryError:
        return None
    if fit.undetermined or refusals(fit):
        return None
    return {name: (of.low, of.high) for name, of in fit.intervals.items()}


def report(cell: Cell, noise_m: float, lasting_s: float, seeds: int) -> None:
    """Print one row."""
    began_s = time.perf_counter()
    found = [intervals_of(cell, seed, noise_m, lasting_s) for seed in range(seeds)]
    told, truth = [each for each in found if each is not None], TRUTHS[cell.model]
    hits = {n: np.mean([e[n][0] <= truth[n] <= e[n][1] for e in told]) for n in truth if told}
    widths = {n: np.median([e[n][1] - e[n][0] for e in told]) for n in truth if told}
    print(
        f"{cell.model:13} {cell.duration_s:4g} {cell.pose_hz:4g} {noise_m:6g} {cell.wander:6g}"
        f"  {np.mean(list(hits.values())):6.1%}  {1 - len(told) / seeds:6.1%}  "
        + " ".join(f"{name} {hit:.0%}" for name, hit in hits.items())
        + "  "
        + " ".join(f"{width:.3g}" for width in widths.values())
        + f"  {(time.perf_counter() - began_s) / seeds:.1f} s",
        flush=True,
    )


def main() -> None:
    """Run the study and print its table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("--model", action="append", choices=list(TRUTHS))
    parser.add_argument("--wander", type=float, action="append")
    parser.add_argument("--lasting", type=float, default=0.0)
    given = parser.parse_args()
    print("model            s   Hz  noise wander  covered  refused  by parameter; median widths")
    for model in given.model or TRUTHS:
        for wander in given.wander or (0.0, 0.05):
            for duration_s in DURATIONS_S:
                for hz in POSITION_HZ:
                    for noise_m in NOISE_M:
                        cell = Cell(model, duration_s, hz, False, 1.0, wander)
                        report(cell, noise_m, given.lasting, given.seeds)


if __name__ == "__main__":
    main()
