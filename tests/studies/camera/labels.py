"""Patches that `label` cuts from one synthesised run, and how a classifier of them drives the next.

    python -m tests.studies.camera.labels [--seeds 5] [--photos FOLDER]
        [--terrains gravel sand tile]
        [--first-seed 0] [--image-rate 4.0]

Without --photos both runs lie on the left halves of scikit-image's photographs, laid at other
places: a robot that comes back to a site. With FOLDER/<terrain>/*.jpg the photographs are parted by
photo_id: one half for the first run and everything that is trained on, the other for the next run,
whose ground is in no training image. Printed of the first run: the share of patches that lie on the
terrain of their label, whole and with their middle, by the true map, computed here. Of the next
run, for classifiers trained on the labelled patches, on the photographs of the first run, and on as
many of these as its ground has: error per metre over 5 m, switches and those within 0.25 m of the
true edge, changes that were missed, and the share of labels that are right.
"""

import argparse
import csv
import shutil
import tempfile
from dataclasses import dataclass, replace
from math import pi
from pathlib import Path

import numpy as np
from tqdm import tqdm

from odometry.recording.run import Run
from terrain.classification.photographs.patches import find_photos
from terrain.classification.training import train
from terrain.labelling.given_terrain import TerrainSpan, given_by_spans, given_terrain
from terrain.labelling.label_runs import label_runs
from terrain.labelling.patch_files import write_labelled_patches
from terrain.main_job import RunResult, run_odometry
from terrain.result.label_confusion import label_confusions
from terrain.result.switch_delay import switch_delays
from terrain.synthesis.config import SynthesisConfig
from terrain.synthetic import synthesise

NEAR_M = 0.25
GROUND_PHOTOS = 3  # of a terrain, at the most: `synthesise` lays so many
ROUNDED_S = 1.0  # a person reads times off a clock


@dataclass(frozen=True)
class Drive:
    """What one classifier did on the next run."""

    per_m: float
    switches: int
    near: int
    missed: int
    right: float
    unknown: float


def main() -> None:
    """Run the study and print its tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--image-rate", type=float, default=4.0)
    parser.add_argument("--photos", type=Path, default=None)
    parser.add_argument("--terrains", nargs=3, default=None)
    arguments = parser.parse_args()
    terrains = arguments.terrains or (
        ["gravel", "sand", "tile"] if arguments.photos else ["gravel", "grass", "brick"]
    )
    placed: dict[str, list[tuple[int, int, int]]] = {}
    driven: dict[str, list[Drive]] = {}
    with tempfile.TemporaryDirectory() as scratch:
        for seed in tqdm(range(arguments.first_seed, arguments.first_seed + arguments.seeds)):
            folder = Path(scratch) / f"{seed}"
            photos = parted(arguments.photos, terrains, folder, seed) if arguments.photos else None
            first, second = two_runs(folder, seed, terrains, photos, arguments.image_rate)
            for name, counts in patches_of(folder, first).items():
                placed.setdefault(name, []).append(counts)
            for name, drive in drives_over(folder, first, second).items():
                driven.setdefault(name, []).append(drive)
            for name, drives in driven.items():
                tqdm.write(f"seed {seed}: {name}: {drives[-1]}")
    print("patches: on the terrain of their label, whole and with their middle [%]")
    for name, counts in placed.items():
        number, whole, middle = np.sum(counts, axis=0)
        print(f"  {name:34s} {100 * whole / number:6.2f} {100 * middle / number:6.2f} of {number}")
    print("next run: error [m/m], switches, near, missed, labels right, unknown")
    for name, drives in driven.items():
        table = np.array([list(vars(drive).values()) for drive in drives])
        per_m, switches, near, missed, right, unknown = table.T
        print(
            f"  {name:34s} {np.mean(per_m):.4f} {switches.sum():4.0f} {near.sum():4.0f} "
            f"{missed.sum():4.0f} {np.mean(right):.3f} {np.mean(unknown):.3f}   by seed: "
            + " ".join(f"{value:.4f}" for value in per_m)
        )


def two_runs(out: Path, seed, terrains, photos, image_rate_hz) -> list[Path]:
    """The first run, and the next one in another order of terrains."""
    again = terrains[-1:] + terrains[:-1]
    folders = []
    for turn, zones in enumerate((terrains, again)):
        config = SynthesisConfig(
            seed=2 * seed + turn, zones=tuple(zones), image_rate_hz=image_rate_hz
        )
        own = photos[turn] if photos else None
        folders.append(synthesise(out / f"run_{turn}", config, photos=own))
    return folders


def patches_of(out: Path, first: Path) -> dict[str, tuple[int, int, int]]:
    """Patches of the first run by what states the terrain; those of truth.csv are written."""
    run = Run.read(first)
    without = replace(run, pose=None, odometry=without_gyroscope(run.odometry))
    found = {}
    for name, (recorded, told) in {
        "truth.csv": (run, given_terrain(run, "truth.csv")),
        "images.csv": (run, given_terrain(run, "images.csv")),
        f"spans, rounded to {ROUNDED_S:g} s": (run, rounded_spans(run)),
        "truth.csv, no poses, no gyroscope": (without, given_terrain(without, "truth.csv")),
    }.items():
        ground = label_runs([recorded], [told])
        found[name] = on_their_terrain(run, ground.chosen, ground.scale.side_m)
        if name == "truth.csv":
            write_labelled_patches(out / "labelled", ground)
    return found


def drives_over(out: Path, first: Path, second: Path) -> dict[str, Drive]:
    """The next run, by each classifier of the first one, and by sources without images."""
    few_photos(first / "patches", out / "few")
    models = {
        "trained on label's patches": train(out / "labelled").classifier,
        "trained on the photographs": train(first / "patches").classifier,
        f"trained on {GROUND_PHOTOS} photographs a class": train(out / "few").classifier,
    }
    parameters = second / "parameters.toml"
    found = {
        name: numbers(run_odometry(second, model=model, parameters=parameters))
        for name, model in models.items()
    }
    for name, source in {"true labels": "labels", "one terrain throughout": "none"}.items():
        found[name] = numbers(run_odometry(second, source=source, parameters=parameters))
    return found


def parted(photos: Path, terrains, out: Path, seed: int) -> tuple[Path, Path]:
    """Two folders that share no photo_id, with copies of the photographs."""
    rng = np.random.default_rng(seed)
    folders = out / "photos_first", out / "photos_next"
    rows = {folder: ["path,photo_id"] for folder in folders}
    found = [photo for photo in find_photos(photos) if photo.label in terrains]
    for terrain in terrains:
        groups = sorted({photo.group for photo in found if photo.label == terrain})
        half = set(rng.permutation(groups)[: len(groups) // 2].tolist())
        for photo in found:
            if photo.label != terrain:
                continue
            folder = folders[photo.group not in half]
            (folder / terrain).mkdir(parents=True, exist_ok=True)
            shutil.copy(photo.path, folder / terrain)
            rows[folder].append(f"{terrain}/{photo.path.name},{photo.group}")
    for folder, lines in rows.items():
        (folder / "manifest.csv").write_text("\n".join(lines) + "\n")
    return folders


def few_photos(patches: Path, out: Path) -> None:
    """Patches of the first GROUND_PHOTOS photographs of each terrain."""
    with (patches / "manifest.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    kept = [
        row
        for name in sorted({row["class"] for row in rows})
        for row in rows
        if row["class"] == name
        and row["photo_id"]
        in sorted({other["photo_id"] for other in rows if other["class"] == name})[:GROUND_PHOTOS]
    ]
    for row in kept:
        (out / row["path"]).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(patches / row["path"], out / row["path"])
    with (out / "manifest.csv").open("w", newline="") as stream:
        writer = csv.DictWriter(stream, list(rows[0]))
        writer.writeheader()
        writer.writerows(kept)


def without_gyroscope(odometry):
    """The table without its column gyro_z."""
    columns = {name: column for name, column in odometry.columns.items() if name != "gyro_z"}
    return replace(odometry, columns=columns)


def rounded_spans(run: Run):
    """Spans of truth.csv whose times are rounded, as someone who watched would write them."""
    names = np.append(run.truth["terrain"], "")
    changes = np.flatnonzero(names[1:] != names[:-1]) + 1
    stamps_s = run.truth.stamps_s - run.truth.stamps_s[0]
    ends_s = np.round(stamps_s[np.minimum(changes, len(stamps_s) - 1)] / ROUNDED_S) * ROUNDED_S
    spans, begin_s = [], 0.0
    for change, end_s in zip(changes, ends_s.tolist(), strict=True):
        spans.append(TerrainSpan(begin_s, end_s, str(names[change - 1])))
        begin_s = end_s
    return given_by_spans(run, spans, run.truth.stamps_s[0])


def on_their_terrain(run: Run, chosen, side_m: float) -> tuple[int, int, int]:
    """Patches, those that lie whole on the terrain of their label, and those whose middle does."""
    source = run.settings["source"]
    edges_m, strips = np.array(source["edges_m"]), np.array(source["strips"])
    truth = run.truth
    whole = middle = 0
    grid = np.linspace(-side_m / 2, side_m / 2, 9)
    for each in chosen:
        square = each.of.square
        row = int(np.abs(truth.stamps_s - square.stamp_s).argmin())
        x, y, yaw = (truth[name][row] for name in ("x", "y", "yaw"))
        ahead, left = np.meshgrid(*(grid + of for of in square.rectangle.middle))
        world_x = x + np.cos(yaw) * ahead - np.sin(yaw) * left
        world_y = y + np.sin(yaw) * ahead + np.cos(yaw) * left
        long_phase, short_phase = source["edge_wave_phases_rad"]
        wave = np.sin(2 * pi * world_y / 1.7 + long_phase)
        wave = wave + 0.4 * np.sin(2 * pi * world_y / 0.43 + short_phase)
        strip = (world_x - source["edge_wave_m"] * wave)[..., None] >= edges_m
        right = strips[strip.sum(axis=-1)] == each.label
        whole += bool(right.all())
        middle += bool(right[4, 4])
    return len(chosen), whole, middle


def numbers(result: RunResult) -> Drive:
    """Error, switches and labels of one replay."""
    delays = switch_delays(result)
    late_m = [delay.late_m for delay in delays if delay.late_m is not None]
    confusion = label_confusions(result).get("truth.csv")
    right, unknown = float("nan"), 0.0
    if confusion is not None:
        right = confusion.right_share or 0.0
        silent = [label in {"unknown", "no label"} for label in confusion.labels]
        unknown = float(confusion.counts[:, silent].sum() / confusion.counts.sum())
    return Drive(
        result.scores["odometer"].mean_translation_per_m,
        len(result.changes),
        sum(abs(value) <= NEAR_M for value in late_m),
        len(delays) - len(result.changes),
        right,
        unknown,
    )


if __name__ == "__main__":
    main()
