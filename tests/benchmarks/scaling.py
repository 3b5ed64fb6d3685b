"""How costs grow: times against the size of what is worked on, with slopes, as one picture.

    python -m tests.benchmarks.scaling [--out scaling.png] [--only NAME ...]

A slope of 1 is a cost in proportion. It is that of a line through the logarithms; a fixed part of
the cost bends it towards 0 at small sizes, so the slope of the last two sizes is given beside it.
"""

import argparse
import math
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullLocator

import odometry
import terrain
from odometry.effects.interface.corrected import Added, Corrected
from odometry.effects.motion.curvature import Curvature
from odometry.estimation.imm.ekf_bank import EkfBank
from odometry.estimation.imm.estimator import Imm
from odometry.estimation.imm.markov import ModeChain
from odometry.estimation.imm.mode_belief import ModeBelief
from odometry.identification.problem import Problem
from odometry.identification.solve import solve
from odometry.identification.start import SolverConfig
from odometry.installed import shipped_data
from odometry.models.catalogue import MODELS
from odometry.report.drawing.figure import save_figure
from odometry.windows.config import WindowConfig
from odometry.windows.travel.motion import linearised_window_motion
from odometry.windows.travel.noise import pose_variances
from odometry.windows.travel.windows import windows_of
from terrain.classification.features.features import feature_matrix
from terrain.classification.neighbours.nearest import nearest
from terrain.classification.presets import PRESETS
from terrain.one_thread import one_thread
from terrain.texture import sfta
from tests.benchmarks.test_imm import STEP_S, pose_model
from tests.benchmarks.test_memory import repeated

LEAST_S, REPEATS = 0.05, 3
Work = Callable[[], object]


@dataclass(frozen=True)
class Growth:
    """What is worked on, in what unit, and the work at each size."""

    of: str
    unit: str
    works: Mapping[int, Work]


def demo() -> odometry.Run:
    """The run that the others are made of."""
    return odometry.Run.read(shipped_data() / "runs" / "demo")


def images(_: Path) -> Growth:
    """SFTA of square images."""
    rng = np.random.default_rng(0)
    sides = (100, 200, 400, 800)
    greys = {side * side: rng.integers(0, 256, (side, side), np.uint8) for side in sides}
    return Growth("SFTA", "pixels", {size: lambda g=grey: sfta(g) for size, grey in greys.items()})


def patches(_: Path) -> Growth:
    """Features of the default preset."""
    rng, settings = np.random.default_rng(0), PRESETS["default"].features
    cuts = [rng.integers(0, 256, (128, 128), np.uint8) for _ in range(16)]
    return Growth(
        "features, default preset",
        "patches of 128 px",
        {n: lambda n=n: feature_matrix(cuts[:n], settings) for n in (1, 2, 4, 8, 16)},
    )


def training(_: Path) -> Growth:
    """Neighbours of four patches."""
    rng = np.random.default_rng(0)
    points, asked = rng.normal(size=(100_000, 12)), rng.normal(size=(4, 12))
    return Growth(
        "neighbours of four patches",
        "patches in training",
        {
            n: lambda n=n: nearest(points[:n], asked, 9)
            for n in (1000, 3000, 10_000, 30_000, 100_000)
        },
    )


def length(folder: Path) -> Growth:
    """The main job without vision."""
    runs = {}
    for copies in (1, 2, 4, 8):
        repeated(demo(), folder / f"{copies}", copies)
        run = odometry.Run.read(folder / f"{copies}")
        runs[len(run.odometry)] = run
    return Growth(
        "run without vision",
        "rows of odometry",
        {n: lambda r=run: terrain.run_odometry(r, vision=False) for n, run in runs.items()},
    )


def fit(runs: list[odometry.Run]) -> object:
    """One search for the parameters of `icr`."""
    model, robot, config = MODELS["icr"], runs[0].robot, WindowConfig()
    guess = model.pack(model.guess(robot))
    free = np.ones(len(guess), dtype=bool)
    problem = Problem(model, windows_of(runs, config), guess, free, pose_variances(config))
    return solve(problem, guess, model.ordinary_sizes(robot), SolverConfig(starts=1))


def runs(_: Path) -> Growth:
    """Identification of `icr`, windows cut anew."""
    one = demo()
    return Growth(
        "identification of icr", "runs", {n: lambda n=n: fit([one] * n) for n in (1, 2, 4, 8, 16)}
    )


def steps_of_imm(count: int) -> Work:
    """Fifty steps with so many modes."""
    k, m = np.linspace(0.5, 1.0, count), np.linspace(0.9, 0.4, count)
    chain = ModeChain(np.full(count, 5.0))
    imm = Imm(EkfBank(pose_model(k, m), count), chain.transition, state_angles=(2,), floor=0.0)
    start = ModeBelief.alike(np.zeros(3), 0.01 * np.eye(3), np.full(count, 1 / count))

    def work() -> object:
        belief = start
        for step in range(50):
            seen = np.array([0.04 * step, 0.0, 0.0])
            belief = imm.step(belief, np.array([1.0, 0.0]), seen, STEP_S)
        return belief

    return work


def modes(_: Path) -> Growth:
    """Steps of the IMM on poses."""
    return Growth("50 steps of the IMM", "modes", {n: steps_of_imm(n) for n in (3, 6, 12, 24, 48)})


def effects(_: Path) -> Growth:
    """Motion and derivative of a model with effects, over windows."""
    run = demo()
    windows = windows_of([run], WindowConfig())
    added = Added(Curvature(), np.array([1.0, 0.05, 1.0]))

    def with_effects(count: int) -> Work:
        model = Corrected(MODELS["icr"], run.robot, [added] * count)
        values = model.pack(model.guess(run.robot))
        return lambda: linearised_window_motion(model, values, windows)

    return Growth(
        "motion of windows, and derivative", "effects", {n: with_effects(n) for n in (1, 2, 4, 8)}
    )


GROWTHS = (images, patches, training, length, runs, modes, effects)


def process_time_s(work: Work) -> float:
    """Least of some repeats; short work is repeated within each."""
    started = time.process_time()
    work()
    inner = max(1, math.ceil(LEAST_S / max(time.process_time() - started, 1e-6)))
    found = []
    for _ in range(REPEATS):
        started = time.process_time()
        for _ in range(inner):
            work()
        found.append((time.process_time() - started) / inner)
    return min(found)


def slopes(sizes: np.ndarray, times_s: np.ndarray) -> tuple[float, float]:
    """Of a line through all logarithms, and between the last two."""
    x, y = np.log(sizes), np.log(times_s)
    return float(np.polyfit(x, y, 1)[0]), float((y[-1] - y[-2]) / (x[-1] - x[-2]))


def main() -> None:
    """Measure, print a table, and draw."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--out", type=Path, default=Path("scaling.png"))
    names = [growth.__name__ for growth in GROWTHS]
    parser.add_argument("--only", nargs="*", choices=names, default=names)
    arguments = parser.parse_args()
    measured = []
    for make in (growth for growth in GROWTHS if growth.__name__ in arguments.only):
        with tempfile.TemporaryDirectory() as folder, one_thread():
            growth = make(Path(folder))
            times_s = np.array([process_time_s(work) for work in growth.works.values()])
        sizes = np.array(list(growth.works))
        all_sizes, last = slopes(sizes, times_s)
        measured.append((growth, sizes, times_s, all_sizes, last))
        costs = ", ".join(f"{n}: {1e3 * s:.3g}" for n, s in zip(sizes, times_s, strict=True))
        print(
            f"{growth.of} [ms] by {growth.unit}: {costs}; slope {all_sizes:.2f}, last {last:.2f}",
            flush=True,
        )
    rows = -(-len(measured) // 3)

    def draw(figure: Figure) -> None:
        for place, (growth, sizes, times_s, slope, last) in enumerate(measured):
            axes = figure.add_subplot(rows, 3, place + 1)
            axes.loglog(sizes, 1e3 * times_s, "o-", color="#3366AA", markersize=4)
            axes.loglog(sizes, 1e3 * times_s[-1] * sizes / sizes[-1], color="#BBBBBB", zorder=0)
            axes.set(xlabel=growth.unit, ylabel="time [ms]")
            axes.set_title(f"{growth.of}\nslope {slope:.2f}, at the end {last:.2f}", fontsize=9)
            axes.set_xticks(sizes, [f"{size}" for size in sizes])
            axes.xaxis.set_minor_locator(NullLocator())
            for of in (axes.yaxis.set_major_formatter, axes.yaxis.set_minor_formatter):
                of(FuncFormatter(lambda value, _: f"{value:g}"))
            axes.grid(visible=True)
        figure.tight_layout()

    save_figure(arguments.out, (9.0, 2.9 * rows), draw)
    print(f"wrote {arguments.out}; grey lines are in proportion to the size")


if __name__ == "__main__":
    main()
