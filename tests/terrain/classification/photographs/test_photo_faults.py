"""Folders of photographs of which a class would vanish, or that are no independent photographs."""

import cv2
import numpy as np
import pytest

from terrain.classification.photographs.patches import SUFFIXES, find_photos, load_patches
from terrain.classification.photographs.photo_faults import (
    check_no_photo_in_two_classes,
    look_alikes,
    unread_note,
)
from terrain.classification.photographs.shifted_frames import shifted_frames
from terrain.classification.training import train
from terrain.errors import ImageError, PatchError


@pytest.fixture
def write(tmp_path, rng):
    """Write an image of blobs, or the one given, and return both."""

    def make(name, image=None):
        if image is None:
            blobs = cv2.GaussianBlur(rng.normal(size=(120, 160)), (0, 0), 6)
            image = np.clip(128 + 400 * blobs, 0, 255).astype(np.uint8)
        file = tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        cv2.imwrite(str(file), image)
        return file, image

    return make


@pytest.mark.parametrize("lost", ["mud/a.webp", "mud/b.TIF", "mud/day_1/c.jpg"])
def test_a_class_does_not_vanish(tmp_path, write, lost):
    write("sand/a.jpg")
    file = tmp_path / lost
    file.parent.mkdir(parents=True)
    file.write_bytes(b"an image of another format")
    with pytest.raises(PatchError, match=r"mud holds no photographs that are read, but .*[abc]\."):
        find_photos(tmp_path)


def test_a_folder_of_images_without_terrain_says_how_to_give_them(tmp_path, write):
    write("a.jpg")
    with pytest.raises(PatchError, match=r"holds no photographs; .* given one by one: .*/\*"):
        find_photos(tmp_path)


def test_other_folders_are_no_classes(tmp_path, write):
    write("sand/a.jpg")
    for name in ("notes/read.me", ".cache/a.webp", "empty/.keep"):
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).write_text("text", encoding="utf-8")
    assert [photo.label for photo in find_photos(tmp_path)] == ["sand"]


def test_images_of_a_class_that_are_not_read_are_counted(tmp_path, write):
    photo, _ = write("sand/a.jpg")
    assert unread_note([photo], SUFFIXES) == ""
    for name in ("sand/b.HEIC", "sand/c.webp", "sand/day_2/d.jpg", "sand/.e.webp", "sand/f.txt"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(b"an image")
    note = unread_note([photo], SUFFIXES)
    assert note.startswith("not read: 3 images beside 1 photograph, such as ")
    assert "b.HEIC" in note


def test_all_photographs_that_cannot_be_read_are_counted_at_once(tmp_path, write):
    write("sand/a.jpg")
    for name in "bcdef":
        (tmp_path / f"sand/{name}.jpg").write_bytes(b"no image")
    words = r"5 photographs cannot be read: .*b\.jpg: .*c\.jpg: .*d\.jpg: .*; and 2 more$"
    with pytest.raises(ImageError, match=words):
        load_patches(find_photos(tmp_path), 16)


@pytest.mark.parametrize("other", ["Sand", "sand ", "SAND"])
def test_two_spellings_are_no_two_classes(tmp_path, write, other):
    write("sand/a.jpg")
    write(f"{other}/b.jpg")
    with pytest.raises(PatchError, match="differ by capitals, spaces"):
        find_photos(tmp_path)


def test_a_photograph_has_one_label(tmp_path, write):
    _, image = write("sand/a.png")
    write("sand/copy.png", image)  # of the same class: look_alikes says so
    same = [(photo.path, photo.label) for photo in find_photos(tmp_path)]
    check_no_photo_in_two_classes(same)
    write("mud/b.png", image)
    with pytest.raises(PatchError, match="are the same photograph, labelled 'mud' and 'sand'"):
        train(tmp_path)


def test_frames_of_one_scene_look_alike_and_other_photographs_do_not(write, rng):
    first, image = write("sand/a.jpg")
    noisy = np.clip(image + rng.normal(scale=10, size=image.shape), 0, 255).astype(np.uint8)
    second, _ = write("sand/b.jpg", noisy)
    third, _ = write("sand/c.jpg")
    flat = [write(f"sand/flat_{n}.png", np.full((64, 64), 90, np.uint8))[0] for n in range(2)]
    photos = [first, second, third, *flat]
    own_groups = {photo: str(photo) for photo in photos}
    assert look_alikes(own_groups) == [(first, second), (second, first)]
    assert look_alikes({**own_groups, first: "scene", second: "scene"}) == []


def test_shifted_frames_of_a_burst_look_alike(write, rng):
    _, scene = write("scene.png", np.kron(rng.integers(60, 190, (120, 160)), np.ones((2, 2), int)))
    frames = [
        write(f"sand/IMG_{n}.png", scene[9 * n : 9 * n + 200, 7 * n : 7 * n + 260])[0]
        for n in range(3)
    ]
    others = [write(f"sand/IMG_{n}.jpg", rng.integers(60, 190, (200, 260)))[0] for n in (5, 6)]
    alike = look_alikes({photo: str(photo) for photo in [*frames, *others]})
    assert sorted({one for one, _ in alike}) == frames
    assert look_alikes(dict.fromkeys(frames, "scene")) == []


def test_a_burst_in_two_folders_looks_alike(write, rng):
    _, scene = write("scene.png", np.kron(rng.integers(60, 190, (120, 160)), np.ones((2, 2), int)))
    frames = [
        write(f"{folder}/IMG_{n}.png", scene[9 * n : 9 * n + 200, 7 * n : 7 * n + 260])[0]
        for n, folder in enumerate(("sand", "sand", "mud", "mud"))
    ]
    alike = look_alikes({photo: str(photo) for photo in frames})
    assert (frames[1], frames[2]) in alike  # beside those within each folder


def test_all_of_many_copies_are_joined(write, rng):
    """However near some of them are to each other."""
    _, image = write("scene.png")
    noise = (rng.integers(0, 9, image.shape, np.uint8) for _ in range(8))
    copies = [write(f"sand/{n}.png", image // 2 + of)[0] for n, of in enumerate(noise)]
    alike = look_alikes({photo: str(photo) for photo in copies})
    assert {(photo, copies[0]) for photo in copies[1:]} <= set(alike)


@pytest.mark.parametrize(("between", "alike"), [(4, True), (5, False)])
def test_a_frame_is_compared_with_five_before_it(write, rng, between, alike):
    """Of other scenes in between."""
    _, scene = write("scene.png", np.kron(rng.integers(60, 190, (120, 160)), np.ones((2, 2), int)))
    first, _ = write("sand/0.png", scene[:200, :260])
    others = [write(f"sand/{n + 1}.png")[0] for n in range(between)]
    last, _ = write("sand/9.png", scene[9:209, 7:267])
    found = list(shifted_frames({photo: str(photo) for photo in [first, *others, last]}))
    assert found == ([(first, last)] if alike else [])


@pytest.mark.parametrize(
    "change",
    [np.fliplr, np.flipud, np.rot90, lambda image: np.rot90(image, 2), np.transpose],
    ids=["mirrored", "upside down", "turned", "by half a turn", "transposed"],
)
def test_copies_that_were_turned_or_mirrored_look_alike(write, change):
    first, image = write("sand/a.png")
    smaller = cv2.resize(np.ascontiguousarray(change(image)), None, fx=0.8, fy=0.8)
    second, _ = write("sand/z.jpg", smaller)
    others = [write(f"sand/{n}.jpg")[0] for n in range(6)]
    alike = look_alikes({photo: str(photo) for photo in [first, second, *others]})
    assert alike == [(first, second), (second, first)]


def test_pieces_of_one_photograph_look_alike(write, rng):
    whole = cv2.GaussianBlur(rng.normal(size=(400, 600)), (0, 0), 2)
    whole = np.clip(128 + 300 * whole, 0, 255)
    pieces = [
        write(f"sand/{row}_{column}.jpg", whole[row : row + 200, column : column + 200])[0]
        for row in (0, 200)
        for column in (0, 400)
    ]
    middle, _ = write("soil/0.jpg", whole[:200, 200:400])
    photos = [*pieces, middle]
    found = dict(look_alikes({photo: str(photo) for photo in photos}))
    assert set(found) == set(photos)
    assert found[middle] in {pieces[0], pieces[1]}
    assert look_alikes(dict.fromkeys(photos, "one photograph")) == []
