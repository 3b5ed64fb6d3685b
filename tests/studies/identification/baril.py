"""Five models on a Warthog's recordings, fitted as in Baril 2020: Table I, and Fig. 4 to 8.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.identification.baril [--out FOLDER]

The robot of the paper on asphalt and ice, where the paper has concrete and snow (Table I on
grass, gravel and sand, too). Loss and windows are those of the paper: eq. 13 with the identity,
segments of 2 m end to end. Errors are of recordings that a model was not identified on. Figures
of the comparison are written to FOLDER/report.html.
"""

import argparse
import os
import tempfile
from itertools import pairwise
from pathlib import Path

import numpy as np

from odometry.comparison.compare import compare
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.result import Comparison
from odometry.comparison.summary import Place
from odometry.identification.fit import fit
from odometry.identification.start import SolverConfig
from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.parameters import read_parameters
from odometry.recording.run import Run
from odometry.report.comparison.comparison_page import write_comparison_report
from odometry.windows.config import WindowConfig
from odometry.windows.travel.windows import windows_of
from tests.studies.identification.real_models import recordings

PRINTED = Path(__file__).parents[3] / "data" / "parameters"
FITTED = ("icr_symmetric", "icr", "radius_of_curvature", "full_linear")
SOLVER, WINDOWS = SolverConfig(loss="linear", starts=1), WindowConfig(horizon_m=2.0)
CONFIG = ComparisonConfig(WINDOWS, SOLVER, training_horizons_m=(0.5, 1.0, 2.0, 5.0, 10.0, 15.0))
TERRAINS = ("asphalt", "ice")
RATIOS = (-1.01, -0.75, -0.25, 0.25, 0.4, 0.6, 0.8, 0.95, 1.0)  # slower tread over faster


def main() -> None:
    """Run the study and print its tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=None, help="keep the page here")
    arguments = parser.parse_args()
    groups = recordings(Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion")
    warthog = {
        name.removeprefix("Clearpath_Warthog_"): runs
        for name, runs in groups.items()
        if name.startswith("Clearpath_Warthog_") and "not" not in name
    }
    print_parameters(warthog)
    compared = compare(
        [run for terrain in TERRAINS for run in warthog[terrain]],
        ("differential_drive", *FITTED),
        config=CONFIG,
    )
    robot = compared.robots_and_terrains[0][0]
    for terrain in TERRAINS:
        print_horizons(compared, robot, terrain)
        print_errors(compared, Place(robot, terrain, 2.0))
        print_turns(compared, Place(robot, terrain, 1.0))
        print_ratios(compared, Place(robot, terrain, 2.0))
    with tempfile.TemporaryDirectory() as scratch:
        write_comparison_report(compared, arguments.out or Path(scratch))


def print_parameters(warthog: dict[str, list[Run]]) -> None:
    """Table I: printed, then by terrain; and the turn of a tread difference of 1 m/s."""
    turning = np.array([[-0.5, 0.5]])
    for name in FITTED:
        model = MODELS[name]
        print(f"\n{name}: parameters; turn on the spot at v_right - v_left = 1 m/s [rad/s]")
        sets = {
            f"printed, {terrain}": dict(table.values)
            for terrain, table in read_parameters(PRINTED / f"warthog_{name}.toml").terrains.items()
        }
        for terrain, runs in warthog.items():
            windows = windows_of(runs, WINDOWS)
            found = fit(
                model,
                windows,
                runs[0].robot,
                fixed={},
                window_config=WINDOWS,
                solver_config=SOLVER,
            )
            sets[terrain] = dict(found.values)
        for terrain, values in sets.items():
            omega = model.twist(model.pack(values), Inputs(turning))[0, 2]
            words = ", ".join(f"{key} {value:.3g}" for key, value in values.items())
            print(f"  {terrain:18} {omega:.3f}   {words}")


def print_horizons(compared: Comparison, robot: str, terrain: str) -> None:
    """Fig. 4: median translation error of `icr`, a row a training horizon."""
    errors = compared.horizon_errors_of(robot, terrain)["icr"]
    print(f"\n{terrain}, Fig. 4: h_t, then median [interquartile range] m per m by h_e")
    for training_m in sorted({each.training_m for each in errors}):
        here = [each.summary for each in errors if each.training_m == training_m]
        cells = []
        for summary in sorted(here, key=lambda each: each.place.horizon_m):
            low, median, high = summary.quartiles["translation"]
            cells.append(f"{summary.place.horizon_m:g} m {median:.3f} [{high - low:.3f}]")
        print(f"  {training_m:4g} m:", "; ".join(cells))


def print_errors(compared: Comparison, place: Place) -> None:
    """Fig. 5 and 6: quartiles of held-out errors by model."""
    print(f"{place.terrain}, Fig. 5 and 6: 25, 50, 75 % of m per m; degrees per m")
    for summary in compared.summaries_at(place):
        parts = [
            " ".join(f"{value:.3f}" for value in summary.quartiles[quantity])
            for quantity in ("translation", "rotation")
        ]
        print(f"  {summary.model:20}", "; ".join(parts))


def print_turns(compared: Comparison, place: Place) -> None:
    """Fig. 7: measured turn over a metre by the turn that an ideal drive would make."""
    commanded, measured = [], []
    for each in compared.evaluations_at(place):
        left, right = each.mean_speeds_m_s.T
        seconds = each.windows.integrated(np.ones(len(each.windows.steps_s)))
        width_m = 1.2  # b of Table I
        commanded.append(np.degrees((right - left) * seconds / width_m) / each.windows.travel_m)
        measured.append(np.degrees(each.windows.measured[:, 2]) / each.windows.travel_m)
    asked, turned = np.concatenate(commanded), np.concatenate(measured)
    turned, asked = turned * np.sign(asked), np.abs(asked)
    print(f"{place.terrain}, Fig. 7: commanded, then 25, 50, 75 % of measured degrees over 1 m")
    for low in range(0, 90, 10):
        inside = (asked >= low) & (asked < low + 10)
        if inside.sum() >= 4:
            quartiles = np.percentile(turned[inside], [25, 50, 75])
            print(f"  {low}-{low + 10}:", " ".join(f"{v:.1f}" for v in quartiles), inside.sum())


def print_ratios(compared: Comparison, place: Place) -> None:
    """Fig. 8: mean errors of `icr_symmetric` by the ratio of slower to faster tread."""
    slower, turns, ways = [], [], []
    for each in compared.evaluations_at(place):
        speeds = each.mean_speeds_m_s
        order = np.argsort(np.abs(speeds), axis=1)
        small, large = np.take_along_axis(speeds, order, axis=1).T
        slower.append(small / large)
        turns.append(np.degrees(each.errors["icr_symmetric"].rotation_per_m))
        ways.append(each.errors["icr_symmetric"].translation_per_m)
    ratio, rotation, translation = (np.concatenate(each) for each in (slower, turns, ways))
    print(f"{place.terrain}, Fig. 8: slower over faster tread: degrees per m, m per m, windows")
    for low, high in pairwise(RATIOS):
        inside = (ratio > low) & (ratio <= high)
        if inside.any():
            means = rotation[inside].mean(), translation[inside].mean()
            print(f"  {low:g} to {high:g}: {means[0]:.2f}, {means[1]:.3f}, {inside.sum()}")


if __name__ == "__main__":
    main()
