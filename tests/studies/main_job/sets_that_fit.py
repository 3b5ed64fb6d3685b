"""Parameters of one recording on another: what poses and gyroscope say of whether they fit.

    python -m tests.studies.main_job.sets_that_fit [--last]

Needs TERRAIN_ODOMETRY_DATA. The model `icr` is identified on the first 150 s of every recording
with poses. Each set is then compared with every other recording by its poses, and by its gyroscope
alone, as `run` does where no yaw was measured. The thresholds were chosen on DEVELOPMENT; `--last`
takes the others.
"""

import argparse
import os
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

from odometry.errors import OdometryError
from odometry.identification.identify import identify
from odometry.parameters import ParameterSet
from odometry.recording.run import Run
from odometry.recording.run_span import Span, cut_run
from terrain.result.sets_against_gyroscope import sets_against_gyroscope
from terrain.result.sets_against_poses import sets_against_poses

DEVELOPMENT = (
    *("husky_2023_s00", "husky_2023_s02", "warthog_2023_s00"),
    *("warthog_grass_20240729_1446", "warthog_grass_20240729_1404"),
    *("warthog_asphalt_20240920_0813", "warthog_asphalt_slow_20240808_1146_s02"),
    *("warthog_ice_20240730_1630_s00", "warthog_sand_20240925_1413_s00"),
    *("marmotte_boreal_20240125_1215_s00", "marmotte_boreal_20240125_1215_s04"),
)
TERRAIN = "of_the_set"


def recordings():
    """The first 150 s of every recording with poses, by name."""
    folder = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion"
    names = sorted(path.parent.name for path in folder.glob("*/pose.csv"))
    return {name: cut_run(Run.read(folder / name), Span(0.0, 150.0)) for name in names}


def sets_of(runs):
    """A parameter set of one terrain by each recording that determines one."""
    found = {}
    for name, run in runs.items():
        try:
            (table,) = identify([run], "icr").to_parameter_set().terrains.values()
        except OdometryError as error:
            print(f"no set of {name}: {str(error)[:80]}")
            continue
        found[name] = ParameterSet({TERRAIN: table})
    return found


def main():
    """Print how often both agree, and where they do not."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--last", action="store_true", help="The recordings held out.")
    last = parser.parse_args().last
    runs = recordings()
    sets, counts = sets_of(runs), Counter()
    for name, run in runs.items():
        if (name in DEVELOPMENT) == last:
            continue
        stamps_s = run.odometry.stamps_s
        replay = SimpleNamespace(stamps_s=stamps_s, terrains=[TERRAIN] * len(stamps_s))
        for other in sets.keys() - {name}:
            result = SimpleNamespace(run=run, parameters=sets[other], replay=replay)
            by_poses, by_gyroscope = (
                [one.ratios.turns_otherwise for one in compare(result)]
                for compare in (sets_against_poses, sets_against_gyroscope)
            )
            counts[any(by_poses), any(by_gyroscope)] += 1
    for turns, noted in ((True, True), (True, False), (False, True), (False, False)):
        fits = "poses turn otherwise" if turns else "poses fit"
        print(f"{fits}, the gyroscope says {'so' if noted == turns else 'no'}: ", end="")
        print(counts[turns, noted])


if __name__ == "__main__":
    main()
