import cv2
import numpy as np
import pytest

from tests.blind.faults.bases import Base, traits
from tests.blind.faults.recordings import table_text

CAMERA = """
[camera]
image_size = [
    64,
    48,
]
matrix = [
    [
        46.0, 0.0, 31.5
    ],
    [
        0.0, 46.0, 23.5
    ],
    [
        0.0, 0.0, 1.0
    ],
]
mount = [
    0.15, 0.0, 1.2, 0.0, 0.7, 0.0
]
"""


@pytest.fixture(scope="session")
def bases(shared_data, tmp_path_factory):
    """Small recordings that have all that faults need."""
    motion = ("warthog_2023_s04", "warthog_grass_20240729_1404")
    folders = [shared_data / "motion" / name for name in motion]
    folders.append(shared_data / "feel" / "asphalt_00")
    names = [*motion, "feel/asphalt_00"]
    real = [Base(n, f, traits(n, f)) for n, f in zip(names, folders, strict=True)]
    made = tmp_path_factory.mktemp("bases")
    return [*real, with_images(made / "images"), with_truth(made / "truth")]


def with_images(folder):
    rng = np.random.default_rng(0)
    (folder / "images").mkdir(parents=True)
    names = [f"images/{number}.jpg" for number in range(6)]
    for name in names:
        cv2.imwrite(str(folder / name), rng.integers(0, 255, (48, 64, 3), np.uint8))
    t = np.arange(6) * 0.5
    write_drive(folder, t, CAMERA)
    (folder / "images.csv").write_text(table_text({"t": t, "file": np.array(names, object)}))
    return Base("synthesised_here", folder, traits("synthesised_here", folder))


def with_truth(folder):
    folder.mkdir()
    write_drive(folder, np.arange(20) * 0.1, "")
    (folder / "truth.csv").write_bytes((folder / "pose.csv").read_bytes())
    return Base("simulated_with_truth", folder, frozenset({"truth"}))


def write_drive(folder, t, camera):
    zero = np.zeros(len(t))
    (folder / "run.toml").write_text(f"[robot]\ntrack_width = 0.5\n{camera}")
    odometry = {"t": t, "v_left": zero + 1, "v_right": zero + 1}
    (folder / "odometry.csv").write_text(table_text(odometry))
    (folder / "pose.csv").write_text(table_text({"t": t, "x": t, "y": zero, "yaw": zero}))
