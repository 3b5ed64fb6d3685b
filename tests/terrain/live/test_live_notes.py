"""What a live run says beside its estimates."""

from copy import copy
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from odometry.parameters import ParameterSet
from odometry.recording.frames import Frame
from odometry.recording.run import Robot, Run
from terrain.camera.camera import Camera
from terrain.images import read_image
from terrain.live.images_so_far import ImagesSoFar
from terrain.live.live_odometry import LiveOdometry
from tests.terrain.live.test_live_odometry import SET


def test_terrains_that_the_set_lacks_are_noted_before_the_first_frame(across_run, classifier):
    run = Run.read(across_run)
    camera = Camera.from_table(run.settings["camera"])
    live = LiveOdometry(run.robot, camera=camera, model=classifier, parameters=SET)
    assert live.notes == ()
    other = ParameterSet({"Boards": SET.terrains["boards"]})
    live = LiveOdometry(run.robot, camera=camera, model=classifier, parameters=other)
    (note,) = live.notes
    assert note.startswith("the model knows 'boards', 'gravel', the parameter set does not")
    assert note.endswith("'Boards' there is 'boards' here: give both one name")


def test_a_set_of_another_robot_is_noted():
    live = LiveOdometry(Robot(0.4), parameters=replace(SET, vehicle={"track_width": 1.2}))
    (note,) = live.notes
    assert note.startswith("the parameter set is of a robot of track width 1.2 m")


def test_images_of_another_size_have_no_label_and_one_note(across_run, classifier):
    run = Run.read(across_run)
    camera = Camera.from_table(run.settings["camera"])
    live = LiveOdometry(run.robot, camera=camera, model=classifier)
    halves = [replace(f, image=f.image and read_image(f.image)[::2, ::2]) for f in run.frames()]
    labels = [s.image_label for s in map(live.step, halves) if s and s.image_label]
    assert not any(label.label for label in labels)
    (note,) = live.notes
    odd = sum(label.reason == "the image is not of the camera's size" for label in labels)
    assert note.startswith(f"{odd} image(s) are not of the camera's size")
    assert odd > 3


KINDS = {
    "16 bits": lambda image: image.astype(np.uint16) * 257,
    "shares": lambda image: image / 255,
    "one channel": lambda image: image[..., None],
    "alpha": lambda image: np.dstack([image] * 3 + [np.full_like(image, 255)]),
    "of Pillow": Image.fromarray,
}


@pytest.fixture(scope="module")
def labels_of(across_run, classifier):
    """Labels of images of the run, and why there is none."""
    run = Run.read(across_run)
    camera = Camera.from_table(run.settings["camera"])

    def of(frames):
        live = LiveOdometry(run.robot, camera=camera, model=classifier)
        labels = [step.image_label for step in map(live.step, frames) if step and step.image_label]
        return [(label.label, label.reason) for label in labels]

    return of


@pytest.fixture(scope="module")
def shown(across_run, labels_of):
    """Frames of the run with their bytes, and the labels of these."""
    frames = list(Run.read(across_run).frames())[:60]
    frames = [replace(frame, image=frame.image and read_image(frame.image)) for frame in frames]
    return frames, labels_of(frames)


@pytest.mark.parametrize("change", KINDS.values(), ids=KINDS)
def test_images_of_other_kinds_have_the_labels_of_their_bytes(change, shown, labels_of):
    frames, labels = shown
    changed = [replace(f, image=None if f.image is None else change(f.image)) for f in frames]
    assert any(label for label, _ in labels)
    assert labels_of(changed) == labels


def test_what_is_no_image_has_no_label_and_ends_nothing(across_run, classifier):
    run = Run.read(across_run)
    camera = Camera.from_table(run.settings["camera"])
    live = LiveOdometry(run.robot, camera=camera, model=classifier)
    odd = [replace(f, image=f.image and np.zeros((4, 4, 2))) for f in list(run.frames())[:60]]
    labels = [s.image_label for s in map(live.step, odd) if s and s.image_label]
    assert "the image cannot be read" in {label.reason for label in labels}


@pytest.mark.parametrize("channels", [1, 3])
def test_grey_images_before_a_model_in_colour_have_one_note(channels, across_run, classifier):
    run = Run.read(across_run)
    camera = Camera.from_table(run.settings["camera"])
    in_colour = copy(classifier)
    in_colour.colour_ = True
    live = LiveOdometry(run.robot, camera=camera, model=in_colour)
    frames = [replace(f, image=f.image and read_image(f.image)) for f in list(run.frames())[:60]]
    for frame in frames:
        image = (
            frame.image if channels == 1 or frame.image is None else np.dstack([frame.image] * 3)
        )
        live.step(replace(frame, image=image))
    images = sum(frame.image is not None for frame in frames)
    (note,) = [note for note in live.notes if "grey" in note]
    assert note.startswith(f"{images} of {images} images have no name, since they are grey")


def test_images_that_all_lack_a_name_are_noted_with_the_reason(across_run, classifier):
    """Such as files that a camera driver did not write."""
    run = Run.read(across_run)
    camera = Camera.from_table(run.settings["camera"])
    live = LiveOdometry(run.robot, camera=camera, model=classifier)
    images = 0
    for frame in run.frames():
        live.step(replace(frame, image=frame.image and frame.image.with_name("none.jpg")))
        images += frame.image is not None
        found = [note for note in live.notes if note.startswith(f"no image of {images} so far")]
        assert len(found) == (images >= 20)
    assert images >= 20
    assert "the image cannot be read" in found[0]


def test_time_without_tread_speeds_is_noted():
    live = LiveOdometry(Robot(0.5))
    stamps_s = [*np.arange(0, 3, 0.1), *np.arange(9, 11, 0.1)]
    for row, stamp_s in enumerate(stamps_s):
        assert live.notes == () or stamp_s > 9
        live.step(Frame(stamp_s, np.array([0.5, 0.5]), row, None, None))
    (note,) = live.notes
    assert note.startswith("no tread speeds came for 6.1 s in all while a tread turned")
    assert "until 9.00 s" in note


def test_a_camera_that_falls_silent_is_noted_after_a_way_without_an_image():
    def notes_after(way_m, size, first=True):
        seen = ImagesSoFar(size)
        for row in range(round(way_m / 0.1) + 1):
            image = np.zeros((4, 4), np.uint8) if row % 5 == 0 and first and row <= 20 else None
            seen.drive(Frame(row / 10, np.array([0.9, 1.1]), row, None, image))
        return seen.notes()

    assert notes_after(6.0, (4, 4)) == []
    (note,) = notes_after(8.0, (4, 4))
    assert note.startswith(
        "no image came for the last 6 m of wheel travel (the last one at 2.00 s)"
    )
    (note,) = notes_after(8.0, (4, 4), first=False)
    assert note.startswith("no image came for the last 8 m of wheel travel: the camera")
    assert notes_after(8.0, None) == []


def test_a_live_run_notes_that_no_image_came(across_run, classifier):
    run = Run.read(across_run)
    camera = Camera.from_table(run.settings["camera"])
    live, still = (LiveOdometry(run.robot, camera=camera, model=of) for of in (classifier, None))
    for row in range(120):
        for one in (live, still):
            one.step(Frame(row / 20, np.array([1.0, 1.0]), row, None, None))
    assert [note.split(":")[0] for note in live.notes] == [
        "no image came for the last 6 m of wheel travel"
    ]
    assert still.notes == ()
