"""Where the squares that `label` finds truly lie, on drives with spins, reversals, a rear camera.

    python -m tests.studies.camera.labels_placed [--seeds 10]

Courses of `switching_courses`; `label` opens no image to find squares, so none is drawn. Labelled
by truth.csv, by spans whose ends are rounded to whole seconds, and by truth.csv with neither poses
nor gyroscope. Printed: squares that become patches, the share whose middle, and that of which all
25 points, lie on the terrain of the label by the true pose and the true map; the same of a label
that is taken at the moment of the image; and the share of squares that were left out as astride.
"""

import argparse
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from tqdm import tqdm

from terrain.labelling.given_terrain import given_terrain
from terrain.labelling.label_runs import label_runs
from terrain.labelling.square_labels import STRADDLES
from tests.studies.camera.labels import rounded_spans, without_gyroscope
from tests.studies.main_job.switching_courses import make_course
from tests.studies.main_job.switching_labels import COURSES


def main() -> None:
    """Run the study and print its table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=10)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        for name, settings in COURSES.items():
            study(name, settings, Path(scratch), arguments.seeds)


def study(name, settings, out, seeds) -> None:
    """One kind of course."""
    found: dict[str, list] = {}
    for seed in tqdm(range(seeds), name):
        folder = out / name.replace(" ", "_").replace(",", "") / f"seed_{seed:02d}"
        course = make_course(folder, seed, **settings)
        for source, (run, told) in sources(course.run).items():
            ground = label_runs([run], [told])
            left_out = sum(of[STRADDLES] for of in ground.left_out.values())
            rows = [right(course, each, ground.scale.side_m) for each in ground.chosen]
            astride = left_out / sum(ground.seen.values())
            found.setdefault(source, []).append((len(rows), *np.sum(rows, axis=0), astride))
    print(f"\n{name}: {seeds} drives; patches, middle right, all right, label of image's moment")
    for source, counts in found.items():
        number, middle, whole, at_image = np.sum(counts, axis=0)[:4]
        worst = min(row[2] / row[0] for row in counts)
        print(
            f"  {source:34s} {number:6.0f} {100 * middle / number:7.2f} "
            f"{100 * whole / number:7.2f} (worst drive {100 * worst:.2f}) "
            f"{100 * at_image / number:7.2f}   astride {100 * np.mean(counts, axis=0)[4]:.1f} %",
            flush=True,
        )


def sources(run):
    """Runs and what states their terrain."""
    blind = replace(run, pose=None, odometry=without_gyroscope(run.odometry))
    return {
        "truth.csv": (run, given_terrain(run, "truth.csv")),
        "spans, rounded to 1 s": (run, rounded_spans(run)),
        "truth.csv, no poses, no gyroscope": (blind, given_terrain(blind, "truth.csv")),
    }


def right(course, each, side_m):
    """Whether the middle, all of the square, and the robot at the image are on its terrain."""
    square = each.of.square
    grid = np.linspace(-side_m / 2, side_m / 2, 5)
    offsets = np.stack(np.meshgrid(grid, grid), axis=-1).reshape(-1, 2)
    places = square.rectangle.middle + offsets
    terrains = [course.true_terrain(square.stamp_s, place) for place in places]
    middle = course.true_terrain(square.stamp_s, square.rectangle.middle)
    robot = course.true_terrain(square.stamp_s, np.zeros(2))
    return middle == each.label, set(terrains) == {each.label}, robot == middle


if __name__ == "__main__":
    main()
