"""Whether the order that a comparison states of models holds on a further drive of any robot.

    python -m tests.studies.identification.compare_any_robot [--first-seed 0] [--seeds 80]

Drives come from `tests/blind/any_robot.py`. Beside models that are identified stands the truth. A
claim is a difference of two models whose interval does not hold zero; it is contradicted where the
same models, as identified on all of the run, differ the other way for certain on a further drive
with exact poses; and it is false where a model is better than the truth.
"""

import tempfile
from pathlib import Path

from odometry.comparison.candidates import GivenParameters
from odometry.comparison.compare import DEFAULT_MODELS, compare
from odometry.comparison.statistics import between
from odometry.errors import OdometryError
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.run import Run
from tests.blind.any_robot import write_clean_run
from tests.studies.identification.identify_any_robot import parser_of, share

TRUE, FURTHER = "true", 9
TERRAIN = "yard"


def asked(seed):
    """What a comparison claims of a drive of a robot, beside what a further drive shows."""
    with tempfile.TemporaryDirectory() as folder:
        robot = write_clean_run(Path(folder) / "run", seed)
        table = TerrainParameters("icr", robot.truth)
        true = GivenParameters(TRUE, ParameterSet({TERRAIN: table}, {}))
        try:
            run = Run.read(Path(folder) / "run")
            found = compare([run], [*DEFAULT_MODELS, true], terrain=TERRAIN)
        except OdometryError:
            return []
        known = [GivenParameters(name, of) for (_, name), of in found.parameters.items()]
        further = seen_on(Path(folder) / "further", seed, [*known, true])
    here = found.places[0]
    claims = [each for each in found.differences_at(here) if not each.interval.holds_zero]
    return [claim(each, further) for each in claims]


def seen_on(folder, seed, candidates):
    """Differences on a further drive whose poses are exact; none where it has no window."""
    write_clean_run(folder, seed, FURTHER)
    (folder / "truth.csv").replace(folder / "pose.csv")
    try:
        return compare([Run.read(folder)], candidates, terrain=TERRAIN).differences
    except OdometryError:
        return ()


def claim(one, further):
    """A difference for certain, the better model first, and whether it is contradicted."""
    one = one if one.interval.mean < 0 else one.with_first(one.second)
    there = [each for each in further if each.quantity == one.quantity]
    seen = between(there, one.first, one.second)
    return {
        "better": one.first,
        "worse": one.second,
        "contradicted": None if seen is None else seen.interval.low > 0,
    }


def main():
    options = parser_of(__doc__).parse_args()
    seeds = range(options.first_seed, options.first_seed + options.seeds)
    claims = [each for seed in seeds for each in asked(seed)]
    of_truth = [each for each in claims if TRUE in (each["better"], each["worse"])]
    seen = [each for each in claims if each["contradicted"] is not None]
    false = sum(each["worse"] == TRUE for each in of_truth)
    print("better than the truth, of claims with it:", share(false, len(of_truth)))
    print("contradicted by a further drive, of claims:",
          share(sum(each["contradicted"] for each in seen), len(seen)))  # fmt: skip


if __name__ == "__main__":
    main()
