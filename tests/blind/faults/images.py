"""Faults of the camera and its images."""

import math
import re
import tomllib

import cv2
import numpy as np

from tests.blind.faults.fault import Fault
from tests.blind.faults.stamps import CLOCK, EPOCH_S

IMAGES = frozenset({"images"})


def camera(recording):
    return tomllib.loads(recording.settings)["camera"]


def with_camera(recording, name, value):
    """A key of [camera] replaced; its array may stand on several lines."""
    settings, count = re.subn(
        rf"(?ms)^{name} = \[.*?^\]$", f"{name} = {value!r}", recording.settings
    )
    assert count == 1, name
    return recording.with_settings(settings)


def mount_in_degrees(recording, rng):  # noqa: ARG001
    mount = camera(recording)["mount"]
    return with_camera(recording, "mount", mount[:3] + [math.degrees(a) for a in mount[3:]])


def pitch_reversed(recording, rng):  # noqa: ARG001
    mount = camera(recording)["mount"]
    return with_camera(recording, "mount", [*mount[:4], -mount[4], mount[5]])


def mount_in_mm(recording, rng):  # noqa: ARG001
    mount = camera(recording)["mount"]
    return with_camera(recording, "mount", [1000 * place for place in mount[:3]] + mount[3:])


def matrix_of_another_size(recording, rng):
    """Calibrated at two or three times the width of these images."""
    factor = float(rng.choice([2.0, 3.0]))
    matrix = [[factor * value for value in row] for row in camera(recording)["matrix"][:2]]
    return with_camera(recording, "matrix", [*matrix, [0.0, 0.0, 1.0]])


def _encoded(change, ending):
    """Each image through a function of its pixels."""

    def draw(recording, rng):
        result, names = recording, []
        setting = rng.random()
        for name in recording["images"]["file"]:
            pixels = cv2.imread(str(recording.folder / name))
            new = name.rsplit(".", 1)[0] + ending
            content = cv2.imencode(ending, change(pixels, setting, rng))[1].tobytes()
            result = result.with_file(name, None).with_file(new, content)
            names.append(new)
        return result.with_columns("images", file=np.array(names, object))

    return draw


def resize(pixels, setting, rng):  # noqa: ARG001
    factor = [0.5, 0.75, 1.5, 2.0][int(setting * 4)]
    return cv2.resize(pixels, None, fx=factor, fy=factor)


def crop(pixels, setting, rng):  # noqa: ARG001
    rows = int(pixels.shape[0] * (0.6 + 0.3 * setting))
    return pixels[:rows]


def twelve_bits(pixels, setting, rng):  # noqa: ARG001
    grey = cv2.cvtColor(pixels, cv2.COLOR_BGR2GRAY).astype(np.uint16) * 16
    return grey + rng.integers(0, 16, grey.shape).astype(np.uint16)


def darken(pixels, setting, rng):
    """A lens cap, or an exposure that never ends."""
    level = 2 if setting < 0.5 else 252
    return np.clip(rng.normal(level, 1.5, pixels.shape), 0, 255).astype(np.uint8)


def truncate(recording, rng):
    result = recording
    for name in recording["images"]["file"]:
        content = (recording.folder / name).read_bytes()
        result = result.with_file(name, content[: int(len(content) * rng.uniform(0.02, 0.7))])
    return result


def remove(recording, rng):
    """Files named in images.csv that are not there: all, or a third."""
    share = rng.choice([0.33, 1.0])
    result = recording
    for name in recording["images"]["file"]:
        if share == 1.0 or rng.random() < share:
            result = result.with_file(name, None)
    return result


def freeze(recording, rng):
    """One and the same image all along, or from a third of the run on."""
    names = recording["images"]["file"]
    start = int(rng.choice([0, len(names) // 3]))
    content = (recording.folder / names[start]).read_bytes()
    result = recording
    for name in names[start:]:
        result = result.with_file(name, content)
    return result


def other_clock(recording, rng):
    start = EPOCH_S + rng.uniform(0, 3e7)
    return recording.restamped(lambda t: t + start, ["images"])


def late(recording, rng):
    """Stamped on arrival, or early by a clock of their own."""
    off_s = rng.choice([-1, 1]) * rng.uniform(0.4, 4.0)
    return recording.restamped(lambda t: t + off_s, ["images"])


def backwards(recording, rng):  # noqa: ARG001
    return recording.with_columns("images", file=recording["images"]["file"][::-1].copy())


def disorder(recording, rng):
    """Files sorted by the text of their numbers, or in no order."""
    files = recording["images"]["file"]
    places = sorted(range(len(files)), key=str)
    if len(files) <= 10 or rng.random() < 0.5:
        places = rng.permutation(len(files))
    return recording.with_columns("images", file=files[places])


def turn_over(pixels, setting, rng):  # noqa: ARG001
    return cv2.flip(pixels, -1)


def mirror(pixels, setting, rng):  # noqa: ARG001
    return cv2.flip(pixels, 1)


def wrong_height(recording, rng):
    mount = camera(recording)["mount"]
    times = float(rng.choice([0.5, 0.7, 1.5, 2.0]))
    return with_camera(recording, "mount", [*mount[:2], times * mount[2], *mount[3:]])


def wrong_yaw(recording, rng):
    mount = camera(recording)["mount"]
    turn = rng.choice([-1, 1]) * rng.uniform(0.35, 1.6)
    return with_camera(recording, "mount", [*mount[:5], float(mount[5] + turn)])


def wrong_pitch(recording, rng):
    mount = camera(recording)["mount"]
    turn = rng.choice([-1, 1]) * rng.uniform(0.1, 0.2)
    return with_camera(recording, "mount", [*mount[:4], float(mount[4] + turn), mount[5]])


def wrong_focal_length(recording, rng):
    times = float(rng.choice([0.5, 0.75, 1.35, 2.0]))
    (f_x, _, u), (_, f_y, v), last = camera(recording)["matrix"]
    return with_camera(recording, "matrix", [[times * f_x, 0.0, u], [0.0, times * f_y, v], last])


# fmt: off
FAULTS = (
    Fault("camera_mount_in_degrees", "warning", "The mount's angles are in degrees.",
          ("degree", "deg"), mount_in_degrees, IMAGES, named=True),
    Fault("camera_pitch_reversed", "warning", "The mount's pitch has the wrong sign.",
          ("pitch", "sign", "up", "sky"), pitch_reversed, IMAGES, named=True),
    Fault("camera_mount_in_mm", "warning", "The mount's place is in millimetres.",
          ("mm", "millimet"), mount_in_mm, IMAGES),
    Fault("camera_matrix_of_another_size", "warning", "The matrix is of larger images.",
          ("matrix", "calibrat", "principal", "centre", "another size"), matrix_of_another_size,
          IMAGES),
    Fault("images_of_another_size", "warning", "Images are resized, the calibration is not.",
          ("size", "resolution", "resized", "calibrat", "scaled", "image_size"),
          _encoded(resize, ".png"), IMAGES, named=True),
    Fault("images_cropped", "warning", "Images are cropped, the calibration is not.",
          ("size", "resolution", "crop", "calibrat", "image_size"), _encoded(crop, ".png"), IMAGES,
          ("images_of_another_size",)),
    Fault("images_of_12_bits", "warning", "12-bit data in 16-bit PNG.", ("12", "bit"),
          _encoded(twelve_bits, ".png"), IMAGES, named=True),
    Fault("images_truncated", "warning", "All image files are cut short.",
          ("truncat", "cut", "incomplete", "damaged", "short", "decod", "broken"), truncate,
          IMAGES, named=True),
    Fault("images_missing", "warning", "Image files are not where images.csv says.",
          ("missing", "not there", "no such", "not found", "absent", "exist", "no file"), remove,
          IMAGES),
    Fault("images_frozen", "warning", "The camera repeats one image while the robot drives.",
          ("frozen", "froze", "same", "identical", "repeat", "stuck", "hang"), freeze, IMAGES),
    Fault("images_without_content", "warning", "Images are black or white.",
          ("black", "dark", "white", "expos", "cap", "cover", "flat", "bright", "uniform",
           "contrast"), _encoded(darken, ".png"), IMAGES),
    Fault("images_on_another_clock", "warning", "Images are stamped from 1970, odometry from 0.",
          CLOCK, other_clock, IMAGES),
    Fault("images_late", "warning", "Images are stamped late or early by some tenths to seconds.",
          ("late", "early", "delay", "latency", "arriv", "lag"), late, IMAGES),
    Fault("images_backwards", "warning", "images.csv names the files from last to first.",
          ("order", "revers", "backward"), backwards, IMAGES),
    Fault("images_in_disorder", "warning", "images.csv names the files in another order.",
          ("order", "mixed", "sorted"), disorder, IMAGES),
    Fault("images_upside_down", "warning", "Images are turned by half a turn.",
          ("upside", "half a turn", "180"), _encoded(turn_over, ".png"), IMAGES),
    Fault("images_mirrored", "warning", "Images are mirrored, left is right.",
          ("mirror", "flip"), _encoded(mirror, ".png"), IMAGES),
    Fault("camera_of_another_height", "warning", "The mount's height is wrong by a factor.",
          ("high", "height"), wrong_height, IMAGES),
    Fault("camera_of_another_yaw", "warning", "The mount's yaw is off by 20 degrees and more.",
          ("yaw", "looks", "points", "side", "direction"), wrong_yaw, IMAGES),
    Fault("camera_of_another_pitch", "warning", "The mount's pitch is off by 6 to 11 degrees.",
          ("pitch",), wrong_pitch, IMAGES),
    Fault("camera_of_another_focal_length", "warning", "The focal length is wrong by a factor.",
          ("focal",), wrong_focal_length, IMAGES),
)
# fmt: on
