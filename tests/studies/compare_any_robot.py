"""Whether the order that a comparison states of models holds on a further drive of any robot.

    python -m tests.studies.compare_any_robot [--first-seed 0] [--seeds 120] [--runs 1]

Drives come from `tests/blind/any_robot.py`. Beside models that are identified stands the truth. A
claim is a difference of two models whose interval does not hold zero; it is contradicted where the
same models, as identified on all of the runs, differ the other way for certain on a further drive
with exact poses; and it is false where a model is better than the truth.
"""

import argparse
import json
import tempfile
import time
import traceback
from pathlib import Path

from odometry.comparison.candidates import GivenParameters
from odometry.comparison.compare import DEFAULT_MODELS, compare
from odometry.comparison.statistics import between
from odometry.errors import OdometryError
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.run import Run
from tests.blind.any_robot import write_clean_run
from tests.studies.identify_any_robot import described, share

TRUE, FURTHER = "true", 9
TERRAIN = "yard"


def true_set(robot):
    return GivenParameters(TRUE, ParameterSet({TERRAIN: TerrainParameters("icr", robot.truth)}, {}))


def further_drive(place, seed):
    """A further drive whose measured poses are exact, at their own rate."""
    folder = place / "further"
    write_clean_run(folder, seed, FURTHER)
    (folder / "truth.csv").replace(folder / "pose.csv")
    return Run.read(folder)


def asked(seed, count):
    """What a comparison claims of the drives of a robot, beside what a further drive shows."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        robots = [write_clean_run(place / f"run_{n}", seed, n) for n in range(count)]
        line = {"seed": seed} | described(robots[0])
        try:
            runs = [Run.read(place / f"run_{n}") for n in range(count)]
            began_s = time.process_time()
            found = compare(runs, [*DEFAULT_MODELS, true_set(robots[0])], terrain=TERRAIN)
            line["took"] = round(time.process_time() - began_s, 1)
            sets = [GivenParameters(name, of) for (_, name), of in found.parameters.items()]
            further = seen_on(further_drive(place, seed), [*sets, true_set(robots[0])])
        except OdometryError as error:
            return line | {"refused": str(error)[:300]}
        except Exception:
            return line | {"crash": traceback.format_exc()[-1500:]}
    line["said"] = found.sentences_at(found.places[0])
    line["windows"] = sum(len(each.windows) for each in found.evaluations_at(found.places[0]))
    line["claims"] = [
        claim(each, further)
        for each in found.differences
        if each.place == found.places[0] and not each.interval.holds_zero
    ]
    return line


def seen_on(run, candidates):
    """Differences on a drive; none where it has no window."""
    try:
        return compare([run], candidates, terrain=TERRAIN).differences
    except OdometryError:
        return ()


def claim(one, further):
    """A difference for certain, with the better model first, and what the further drive shows."""
    if one.interval.mean > 0:
        one = one.with_first(one.second)
    there = [each for each in further if each.quantity == one.quantity]
    seen = between(there, one.first, one.second)
    return {
        "quantity": one.quantity, "better": one.first, "worse": one.second,
        "interval": [one.interval.mean, one.interval.low, one.interval.high],
        "further": None if seen is None else
        [seen.interval.mean, seen.interval.low, seen.interval.high],
    }  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--seeds", type=int, default=120)
    parser.add_argument("--runs", type=int, default=1)
    options = parser.parse_args()
    lines = []
    for seed in range(options.first_seed, options.first_seed + options.seeds):
        lines.append(asked(seed, options.runs))
        print(json.dumps(lines[-1]), flush=True)
    claims = [each for line in lines for each in line.get("claims", ())]
    of_truth = [each for each in claims if TRUE in (each["better"], each["worse"])]
    seen = [each for each in claims if each["further"] is not None]
    print(f"compared {sum('claims' in line for line in lines)}, "
          f"refused {sum('refused' in line for line in lines)}, "
          f"crashed {sum('crash' in line for line in lines)}, "
          f"slowest {max((line.get('took', 0) for line in lines), default=0):.1f} s")  # fmt: skip
    print("better than the truth, of claims with it:",
          share(sum(each["worse"] == TRUE for each in of_truth), len(of_truth)))  # fmt: skip
    print("contradicted by a further drive, of claims:",
          share(sum(each["further"][1] > 0 for each in seen), len(seen)))  # fmt: skip


if __name__ == "__main__":
    main()
