"""Chen's experiment on synthesised runs: terrain A - B - A, with and without vision.

    python -m tests.studies.main_job.switching [--seeds 20] [--out FOLDER] [--rough] [--tuned]

For each seed a run is made, a classifier is trained on its patches (photos that do not lie on its
ground), and the run is replayed with vision, with the true labels at the true edge, by the
paper's own system, without vision, without but with jumps of the ICRs detected from the
innovations, and with --tuned without but with the process noise tuned on these very runs, in its
favour. With --rough wheels are noisier and ICRs wander.
Printed: error per metre over 5 m horizons, mean position error, delay of the switches, time and
metres until the ICRs are within 5 % after a change.
"""

import argparse
import tempfile
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path

import numpy as np
from tqdm import tqdm

from odometry.arrays import FloatArray
from odometry.evaluation.score import score
from odometry.recording.run import Run
from terrain.classification.training import train
from terrain.config import Config
from terrain.main_job import RunResult, run_odometry
from terrain.result.switch_delay import SwitchDelay, switch_delays
from terrain.synthesis.config import SynthesisConfig
from terrain.synthetic import synthesise

TUNED_ICR_NOISE = (0.05, 0.1, 0.2, 0.4, 0.8)  # track widths per square root of second
TUNED_POSE_NOISE = (0.001, 0.003, 0.01)
SETTLED_SHARE = 0.05
SETTLED_S = 1.0
TRUE_LABELS = "true labels at the true edge"
NEAR_M = 0.25  # a switch is meant to be so near to its edge


@dataclass(frozen=True)
class Numbers:
    """What one replay showed."""

    per_m: float
    rotation_per_m: float
    position_m: float
    settled_s: tuple[float, ...]
    settled_m: tuple[float, ...]


def main() -> None:
    """Run the study and print its table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--out", type=Path, default=None, help="keep the runs here")
    parser.add_argument("--rough", action="store_true", help="noisier wheels, wandering ICRs")
    parser.add_argument("--tuned", action="store_true", help="tune a filter without vision, too")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        out = arguments.out or Path(scratch)
        study(out, arguments.seeds, arguments.rough)
        if arguments.tuned:
            tune(out, arguments.seeds, arguments.rough)


def study(out: Path, seeds: int, rough: bool) -> None:
    """Make, train, replay and print."""
    found: dict[str, list[Numbers]] = {}
    delays: list[SwitchDelay] = []
    for seed in tqdm(range(seeds), "seeds"):
        folder = made(out, seed, rough)
        run, parameters = Run.read(folder), folder / "parameters.toml"
        model = train(folder / "patches").classifier
        results = {
            "with vision": run_odometry(run, model=model, parameters=parameters),
            TRUE_LABELS: run_odometry(run, source="labels", parameters=parameters),
            "the paper (--preset chen2023)": _papers(run),
            "without": run_odometry(run, parameters=parameters),
            "without, jumps": run_odometry(run, parameters=parameters, config=_jumps()),
        }
        delays += switch_delays(results["with vision"])
        for name, result in results.items():
            found.setdefault(name, []).append(numbers(result))
        errors = "  ".join(f"{name} {of[-1].per_m:.4f}" for name, of in found.items())
        tqdm.write(f"{folder.name}: {errors}")
    table(found)
    share = np.divide(*(np.mean([n.per_m for n in found[k]]) for k in ("with vision", TRUE_LABELS)))
    print(f"error per metre with vision {share:.2f} times that of {TRUE_LABELS}")
    late_s = [d.late_s for d in delays if d.late_s is not None]
    late_m = [d.late_m for d in delays if d.late_m is not None]
    switches = [d for d in delays if d.in_force_s is not None]
    print(
        f"switches {len(switches)} (true changes {2 * seeds}), "
        f"false {sum(d.true_s is None for d in switches)}, missed {len(delays) - len(switches)}, "
        f"beyond {NEAR_M} m {sum(abs(m) > NEAR_M for m in late_m)}"
    )
    print(f"late by s, median and 5-95 %: {spread(late_s)}; by m: {spread(late_m)}")


def tune(out: Path, seeds: int, rough: bool) -> None:
    """Without vision, with the process noise that is best on the runs themselves."""
    tuned: dict[tuple[float, float], list[Numbers]] = {}
    for seed in tqdm(range(seeds), "tuned"):
        folder = made(out, seed, rough)
        for noises in product(TUNED_ICR_NOISE, TUNED_POSE_NOISE):
            result = run_odometry(
                folder, parameters=folder / "parameters.toml", config=_tuned(*noises)
            )
            tuned.setdefault(noises, []).append(numbers(result))
    best = min(tuned, key=lambda noises: np.mean([n.per_m for n in tuned[noises]]))
    table(
        {f"without, tuned: ICR noise {best[0]} widths, pose noise {best[1]}": tuned[best]},
    )


def made(out: Path, seed: int, rough: bool) -> Path:
    """The run of a seed, kept where it is there already."""
    folder = out / f"seed_{seed:02d}"
    if (folder / "run.toml").exists():
        return folder
    config = SynthesisConfig(seed=seed)
    if rough:
        config = replace(config, sigma_tread_m_s=0.005, icr_wander_m=(0.01, 0.01, 0.004))
    return synthesise(folder, config)


def _papers(run: Run) -> RunResult:
    """The paper's own system, whole; its classifier learns from the same patches."""
    model = train(run.folder / "patches", preset="chen2023").classifier
    return run_odometry(run, model=model, preset="chen2023")


def _jumps() -> Config:
    config = Config()
    return replace(config, filter=replace(config.filter, detect_jumps=True))


def _tuned(icr_noise: float, pose_noise: float) -> Config:
    config = Config()
    return replace(
        config,
        filter=replace(
            config.filter,
            icr_noise_widths=icr_noise,
            position_noise=pose_noise,
            yaw_noise=pose_noise,
        ),
    )


def numbers(result: RunResult) -> Numbers:
    """Errors of the odometer, and how long the ICRs took after each true change."""
    assert result.reference is not None
    errors = score(result.run, result.replay.odometer(), result.reference, result.config.evaluation)
    settled = [settling(result, stamp_s) for stamp_s in true_changes_s(result.run)]
    return Numbers(
        errors.mean_translation_per_m,
        errors.mean_rotation_deg_per_m,
        errors.mean_position_m,
        tuple(seconds for seconds, _ in settled),
        tuple(metres for _, metres in settled),
    )


def true_changes_s(run: Run) -> FloatArray:
    """Stamps at which the robot's centre came onto another terrain."""
    names = run.truth["terrain"]
    return run.truth.stamps_s[1:][names[1:] != names[:-1]]


def settling(result: RunResult, change_s: float) -> tuple[float, float]:
    """Seconds and wheel metres from a change until every ICR is within 5 % of the true width.

    It must stay there for a second. Infinite if it never does before the next change.
    """
    run, stamps_s = result.run, result.replay.stamps_s
    truth = run.truth.stack("y_left", "y_right", "x_icr")
    true_icrs = np.stack([np.interp(stamps_s, run.truth.stamps_s, c) for c in truth.T], axis=-1)
    width = (true_icrs[:, 0] - true_icrs[:, 1])[:, None]
    near = (np.abs(result.replay.means[:, 3:6] - true_icrs) <= SETTLED_SHARE * width).all(axis=1)
    later = true_changes_s(run)
    end_s = min([t for t in later if t > change_s], default=stamps_s[-1])
    for start in np.flatnonzero((stamps_s >= change_s) & (stamps_s <= end_s - SETTLED_S) & near):
        stays = (stamps_s >= stamps_s[start]) & (stamps_s <= stamps_s[start] + SETTLED_S)
        if near[stays].all():
            travel = np.interp(
                [change_s, stamps_s[start]], run.odometry.stamps_s, run.wheel_travel_m
            )
            return float(stamps_s[start] - change_s), float(travel[1] - travel[0])
    return np.inf, np.inf


def table(results: dict[str, list[Numbers]]) -> None:
    """Print means over seeds, their spread, and what vision saves."""
    first = next(iter(results.values()))
    for name, numbers_of in results.items():
        per_m = np.array([n.per_m for n in numbers_of])
        rotation = np.array([n.rotation_per_m for n in numbers_of])
        position = np.array([n.position_m for n in numbers_of])
        seconds = [s for n in numbers_of for s in n.settled_s]
        metres = [m for n in numbers_of for m in n.settled_m]
        print(f"{name}:")
        print(f"  error per metre, mean {per_m.mean():.4f} m/m, 5-95 % of seeds {spread(per_m)}")
        print(f"  heading error per metre, mean {rotation.mean():.3f} deg/m")
        print(f"  mean position error m, median and 5-95 % of seeds: {spread(position)}")
        print(f"  ICRs within 5 % after s: {spread(seconds)}, m: {spread(metres)}")
        if numbers_of is not first:
            mine = np.array([n.per_m for n in first])
            here = np.array([n.position_m for n in first])
            print(f"  vision saves {1 - mine.mean() / per_m.mean():.1%} of the error per metre")
            print(
                f"  and of the mean position error {1 - np.median(here / position):.1%} in the "
                f"median of seeds (5-95 %: {spread(1 - here / position)})"
            )


def spread(values: object) -> str:
    """Median and the range that holds the middle 90 %."""
    low, middle, high = np.percentile(values, [5, 50, 95], method="nearest")
    return f"{middle:.3f} [{low:.3f}, {high:.3f}]"


if __name__ == "__main__":
    main()
