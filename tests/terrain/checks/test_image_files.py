"""Image files that cannot be used, or are one image under many names."""

import struct
import zlib

import cv2
import numpy as np
import pytest

from odometry.arrays import spread
from odometry.checks.findings.finding import Level
from odometry.recording.run import Run
from terrain.checks.image_files import FILES, decode, outside_of_odometry, sample_images


def half(data):
    return data[: len(data) // 2]


CONTENTS = {"truncated": half, "empty": lambda _: b"", "unreadable": lambda _: b"no image at all"}


@pytest.mark.parametrize("words", CONTENTS)
def test_damaged_images_are_named(faulty, words):
    for file in faulty.files:
        file.write_bytes(CONTENTS[words](file.read_bytes()))
    finding = faulty.found()["images_damaged"]
    assert finding.level is Level.WARNING
    assert words in finding.cause
    assert "24 of 24" in finding.seen
    assert "00.jpg" in finding.seen


def test_one_damaged_image_is_a_note(faulty):
    faulty.files[7].write_bytes(half(faulty.files[7].read_bytes()))
    found = faulty.found()
    assert found["images_damaged"].level is Level.NOTE
    assert "1 of 24" in found["images_damaged"].seen


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def test_a_huge_image_is_never_decoded(faulty):
    header = struct.pack(">IIBBBBB", 30000, 30000, 8, 0, 0, 0, 0)
    rows = zlib.compress(bytes(1000))
    chunks = chunk(b"IHDR", header) + chunk(b"IDAT", rows) + chunk(b"IEND", b"")
    for file in faulty.files:
        file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunks)
    image = sample_images(Run.read(faulty.folder))[0]
    assert image.size == (30000, 30000)
    assert decode(image) is None
    assert "megapixels" in faulty.found()["images_damaged"].cause


def test_a_frozen_camera_is_named_with_its_time(faulty):
    for file in faulty.files[10:]:
        file.write_bytes(faulty.files[10].read_bytes())
    finding = faulty.found()["images_frozen"]
    assert "frozen" in finding.cause
    assert finding.seen.startswith("14 of 24 images")
    assert finding.spans_s == ((5.0, 11.5),)


@pytest.mark.parametrize("grey", [0, 255])
def test_black_and_white_images_are_equal_without_a_frozen_camera(faulty, grey):
    for file in faulty.files[10:]:
        image = np.full((120, 160, 3), grey, np.uint8)
        file.write_bytes(cv2.imencode(".jpg", image)[1].tobytes())
    assert "images_frozen" not in faulty.found()


def test_equal_images_of_a_robot_that_stands_are_no_fault(faulty):
    file = faulty.folder / "odometry.csv"
    header, *rows = file.read_text().split()
    times = [row.split(",")[0] for row in rows]
    still = [f"{t},0,0" if float(t) >= 5 else row for t, row in zip(times, rows, strict=True)]
    file.write_text("\n".join([header, *still]) + "\n")
    for image in faulty.files[10:]:
        image.write_bytes(faulty.files[10].read_bytes())
    assert "images_frozen" not in faulty.found()


@pytest.mark.parametrize(("shift_s", "told"), [(0.0, False), (3.0, True), (7.0, False)])
def test_images_outside_of_odometry(faulty, shift_s, told):
    """Where most are outside, the check of stamps speaks."""
    file = faulty.folder / "images.csv"
    header, *rows = file.read_text().split()
    cells = [row.split(",") for row in rows]
    file.write_text("\n".join([header, *(f"{float(t) + shift_s},{n}" for t, n in cells)]) + "\n")
    found = list(outside_of_odometry(Run.read(faulty.folder)))
    assert bool(found) is told
    if found:
        assert "0 images before and 5 after" in found[0].seen


def test_samples_are_few_and_reach_both_ends():
    assert list(spread(5, 20)) == [0, 1, 2, 3, 4]
    rows = spread(100_000, FILES)
    assert len(rows) == FILES
    assert (rows[0], rows[-1]) == (0, 99_999)
    assert len(spread(0, 20)) == 0
