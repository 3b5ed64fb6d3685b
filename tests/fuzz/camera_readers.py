"""Readers of calibrations, transforms and marked points, for fuzzing."""

import numpy as np

from terrain.calibration.mount_from_points import mount_from_points, read_marked_points
from terrain.camera.camera import Camera
from terrain.camera_files.lens_models import Lens
from terrain.camera_files.read import read_calibration
from terrain.camera_files.transforms import mount_in, read_transforms
from tests.fuzz.mutations import text_changed
from tests.fuzz.reader import reader_of


def camera_readers(folder):
    flat = "[501.5, 0.0, 322.25, 0.0, 499.0, 239.0, 0.0, 0.0, 1.0]"
    lens = "[-0.3, 0.1, 1e-05, -0.002, 0.01]"
    texts = {
        "camera_info": "image_width: 640\nimage_height: 480\ncamera_matrix:\n  cols: 3\n"
        f"  data: {flat}\ndistortion_model: plumb_bob\ndistortion_coefficients:\n  data: {lens}\n",
        "camchain": "cam0:\n  camera_model: pinhole\n  intrinsics: [400.0, 401.0, 322.0, 239.0]\n"
        "  distortion_model: equidistant\n  distortion_coeffs: [-0.01, 0.02, -0.01, 0.002]\n"
        "  resolution: [640, 480]\n  T_cam_imu:\n  - [0, -1, 0, 0.1]\n  - [0, 0, -1, 0.2]\n"
        "  - [1, 0, 0, 0.3]\n  - [0, 0, 0, 1]\n",
        "camera XML": f'<?xml version="1.0"?>\n<opencv_storage>\n<size>\n  640 480</size>\n'
        f'<K type_id="opencv-matrix">\n<data>{flat[1:-1].replace(",", "")}</data></K>\n'
        f"<D><data>{lens[1:-1].replace(',', '')}</data></D>\n</opencv_storage>\n",
    }
    for name, text in texts.items():
        file = folder / f"{name}.yaml"
        yield reader_of(
            name,
            file,
            text.encode(),
            text_changed,
            lambda file=file: read_calibration(file, image_size=(640, 480)),
        )
    transforms = folder / "transforms.yaml"
    level = "['0', '0', '1', '0.1', '-1', '0', '0', '0', '0', '-1', '0', '0.5', '0', '0', '0', '1']"
    text = f"T_base_footprint__eye:\n  cols: 4\n  data: {level}\n  rows: 4\n"
    yield reader_of(
        "transforms",
        transforms,
        text.encode(),
        text_changed,
        lambda: mount_in(read_transforms(transforms), "eye"),
    )
    marks = folder / "marks.csv"
    lens = Lens.of((640, 480), [[400, 0, 320], [0, 400, 240], [0, 0, 1]])
    camera = Camera.from_mount((640, 480), lens.matrix, [], [0.2, 0, 0.8, 0, 0.7, 0])
    places = np.array([[0.8, 0.3], [0.8, -0.3], [1.2, 0.0], [1.7, 0.5], [1.7, -0.5]])
    marked = np.hstack([camera.ground_to_pixels(places), places])
    rows = [",".join(map(str, row)) for row in marked.tolist()]
    text = "\n".join(["u,v,x,y", *rows]) + "\n"

    def use_marks():
        mount_from_points(lens, read_marked_points(marks))

    yield reader_of("marks.csv", marks, text.encode(), text_changed, use_marks)
