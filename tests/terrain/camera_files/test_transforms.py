"""Mounts from files of transforms, against matrices that are multiplied by hand."""

import numpy as np
import pytest

from terrain.camera_files.read import read_calibration
from terrain.camera_files.transforms import mount_in, read_transforms
from terrain.errors import CameraError

LEVEL = [[0, 0, 1, 0.1], [-1, 0, 0, 0.02], [0, -1, 0, 0.5], [0, 0, 0, 1]]  # looks ahead, level
DOWN = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -0.13], [0, 0, 0, 1]]


def yaml_of(**transforms):
    return "\n".join(
        f"{name}:\n  rows: 4\n  cols: 4\n  data: {[f'{v:.3f}' for row in rows for v in row]}"
        for name, rows in transforms.items()
    )


def read(tmp_path, **transforms):
    file = tmp_path / "transforms.yaml"
    file.write_text(yaml_of(**transforms))
    return read_transforms(file)


def test_a_level_camera_by_hand(tmp_path):
    found = read(tmp_path, T_base_link__base_footprint=DOWN, T_base_link__eye=LEVEL)
    np.testing.assert_allclose(mount_in(found, "eye"), [0.1, 0.02, 0.63, 0, 0, 0], atol=1e-9)


def test_a_chain_with_rounded_rotations(tmp_path, world):
    """Through a mast that is turned by 45 degrees, in three digits, and against its direction."""
    half = np.sqrt(0.5)
    mast = [[half, -half, 0, 0.2], [half, half, 0, 0.1], [0, 0, 1, 0.4], [0, 0, 0, 1]]
    attitude = world.rotation(0.05, 0.6, -0.3)
    optical = attitude @ np.array([[0, 0, 1], [-1, 0, 0], [0, -1, 0]])
    base_from_eye = np.eye(4)
    base_from_eye[:3, :3], base_from_eye[:3, 3] = optical, [0.3, 0.0, 0.9]
    eye_from_mast = np.linalg.inv(base_from_eye) @ mast
    found = read(
        tmp_path,
        T_base_link__base_footprint=DOWN,
        T_base_link__mast=mast,
        T_eye__mast=eye_from_mast,
    )
    expected = [0.3, 0.0, 1.03, 0.05, 0.6, -0.3]
    np.testing.assert_allclose(mount_in(found, "eye"), expected, atol=2e-3)


@pytest.mark.parametrize(
    ("transforms", "words"),
    [
        ({"T_base_link__eye": LEVEL}, "base_footprint.*height of the camera above the terrain"),
        ({"T_base_link__base_footprint": DOWN}, "no frame 'eye'; found: base_footprint"),
        ({"T_a__base_footprint": DOWN, "T_b__eye": LEVEL}, "no transforms lead"),
        ({"T_base_link__eye": np.ones((4, 4))}, "last row"),
        ({"T_base_link__eye": np.diag([1.0, 1.0, -1.0, 1.0])}, "no rotation"),
        ({"T_base_link__eye": np.diag([1.1, 1.0, 1.0, 1.0])}, "no rotation"),
        ({"camera": LEVEL}, "no transforms"),
    ],
)
def test_what_cannot_be_used_is_said(tmp_path, transforms, words):
    with pytest.raises(CameraError, match=words):
        mount_in(read(tmp_path, **transforms), "eye")


@pytest.mark.parametrize(
    ("robot", "camera", "mount"),
    [
        ("husky", "camera_front", [0.038, -0.020, 0.594, 0, 0, 0]),
        ("husky", "camera_rear", [-0.058, 0, 0.594, 0, 0, np.pi]),
        ("marv", "camera_front", [0.285, 0, 0.275, 0, 0, 0]),
        ("marv", "camera_rear", [-0.285, 0, 0.275, 0, 0, np.pi]),
    ],
)
def test_real_robots(shared_data, robot, camera, mount):
    """Files as they are: the height is that above base_link and of base_link above the terrain."""
    folder = shared_data / "camera-frames" / robot
    found = mount_in(read_transforms(folder / "transformations.yaml"), camera)
    np.testing.assert_allclose(found, mount, atol=1e-6)
    read = read_calibration(folder / f"{camera}.yaml")
    assert read.name == camera
    assert read.lens.image_size == (1920, 1200)
    assert 1170 < read.lens.matrix[0, 0] < 1180
    assert read.lens.distortion[0] == pytest.approx(-0.225, abs=0.01)
