"""Region against whole image: time and agreement (Chen 2023, Table 2 and Fig. 6).

    python -m tests.studies.speed.region_time [--images 60]

On a synthesised run the ground ahead is classified twice in every image: the region where the
kinematic model predicts the robot, and all the ground that the image resolves. They agree where
the region's label is that of most cells of the whole image whose middle lies in the region.
"""

import argparse
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np

from odometry.estimation.icr_ekf import IcrEkf
from odometry.parameters import read_parameters
from odometry.recording.run import Run
from odometry.replays.pipeline import ConstantTerrain, replay
from terrain.camera.camera import Camera
from terrain.classification.training import train
from terrain.config import Config
from terrain.images import read_image
from terrain.region.region import NoRegion, Rectangle, predict_region
from terrain.region.warp import ground_view
from terrain.region.whole_image import classify_ground
from terrain.synthetic import synthesise


def main() -> None:
    """Run the study and print its table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--images", type=int, default=60)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        run = Run.read(synthesise(Path(scratch) / "run"))
        for preset in ("default", "chen2023"):
            study(run, preset, arguments.images)


def study(run: Run, preset: str, images: int) -> None:
    """Classify both ways and print times and agreement."""
    classifier = train(run.folder / "patches", preset=preset).classifier
    scale = classifier.metres_per_pixel
    camera = Camera.from_table(run.settings["camera"])
    parameters = read_parameters(run.folder / "parameters.toml")
    estimator = IcrEkf(run.robot.track_width, parameters)
    source = ConstantTerrain(next(iter(parameters.terrains)))
    estimates = {e.stamp_s: e for e in replay(run, estimator, source).estimates}
    region_s, whole_s, same = [], [], []
    chosen = np.linspace(8, len(run.images) - 1, images).astype(int)
    for row in chosen:
        estimate = estimates[float(run.images.stamps_s[row])]
        image = read_image(run.folder / str(run.images["file"][row]))
        speed = float(np.abs(estimate.tread_speeds_m_s).mean())
        start = time.perf_counter()
        region = predict_region(run.robot, camera, estimate.twist, speed, Config().region)
        if isinstance(region, NoRegion):
            continue
        view = ground_view(image, camera, region.rectangle, scale)
        (answer,) = classifier.classify([view])
        middle = time.perf_counter()
        cells = classify_ground(image, camera, classifier)
        whole_s.append(time.perf_counter() - middle)
        region_s.append(middle - start)
        inside = [c.classification.label for c in cells if _holds(region.rectangle, c.rectangle)]
        if inside:
            same.append(Counter(inside).most_common(1)[0][0] == answer.label)
    ratio = np.array(whole_s) / np.array(region_s)
    print(f"{preset}: {len(region_s)} images")
    for name, values in (("region", region_s), ("whole image", whole_s)):
        print(f"  {name}: mean {np.mean(values):.4f} s, largest {np.max(values):.4f} s")
    print(f"  whole / region, median {np.median(ratio):.1f} (paper: 2.1 s / 0.47 s = 4.5)")
    print(f"  agreement {np.mean(same):.3f} of {len(same)} images")


def _holds(outer: Rectangle, cell: Rectangle) -> bool:
    x, y = (cell.x_min + cell.x_max) / 2, (cell.y_min + cell.y_max) / 2
    return outer.x_min <= x <= outer.x_max and outer.y_min <= y <= outer.y_max


if __name__ == "__main__":
    main()
