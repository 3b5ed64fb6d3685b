"""What `train` says of photographs that look alike, or are small."""

from types import SimpleNamespace

import cv2
import numpy as np

from terrain.classification.answer import COLOURLESS
from terrain.classification.no_ground import SKY
from terrain.classification.photographs.patches import find_photos, load_patches
from terrain.classification.photographs.scenes import with_scenes
from terrain.cli.texts.labelled_images import print_unnamed
from terrain.cli.texts.train_notes import notes


def said(folder, noticed_share=None, **options):
    training = SimpleNamespace(
        classifier=SimpleNamespace(patch_size_px=64, colour_=False, noticed_share_=noticed_share),
        patches=with_scenes(load_patches(find_photos(folder), 64)),
    )
    return list(notes(training, folder, colour=False, **options))


def test_one_scene_with_two_labels_is_named_before_scenes_that_are_there_twice(tmp_path, rng):
    scenes = [cv2.GaussianBlur(rng.normal(size=(120, 160)), (0, 0), 6) for _ in range(2)]
    files = {"sand/a": 0, "sand/b": 0, "mud/a": 1}
    for name, scene in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        image = 128 + 400 * scenes[scene] + rng.normal(scale=5, size=(120, 160))
        cv2.imwrite(f"{tmp_path / name}.png", np.clip(image, 0, 255).astype(np.uint8))
    (copies,) = said(tmp_path)
    assert copies.startswith("Note: 2 of 3 photographs look like another one, such as ")
    again = np.asarray(cv2.imread(f"{tmp_path / 'mud/a'}.png"))
    cv2.imwrite(f"{tmp_path / 'sand/c'}.jpg", again)
    contrary, copies = said(tmp_path)
    assert "2 of 4 photographs look like one with another label" in contrary
    assert f"{tmp_path / 'mud/a'}.png (mud) and {tmp_path / 'sand/c'}.jpg (sand)" in contrary
    assert "2 of 4 photographs look like another one" in copies


def test_photographs_that_make_patches_small_are_named(tmp_path, rng):
    for name, side in {"a": 160, "b": 200, "c": 140, "d": 70}.items():
        image = rng.integers(0, 256, (side, 240)).astype(np.uint8)
        (tmp_path / "sand").mkdir(exist_ok=True)
        cv2.imwrite(f"{tmp_path / 'sand' / name}.png", image)
    (note,) = said(tmp_path, chooses_size=True)
    assert "patches have 64 px in place of 128, which do not fit into 1 of 4 photographs" in note
    assert f"{tmp_path / 'sand/d.png'} (its shorter side: 70 px)" in note
    assert not said(tmp_path)  # the size was given
    (note,) = said(tmp_path, noticed_share=0.5)
    assert note.startswith("Note: images of another camera may pass as those of training")
    for name in "ab":
        (tmp_path / f"sand/{name}.png").unlink()
    assert not said(tmp_path, chooses_size=True)  # half of them are small: so are the photographs


def test_photographs_of_another_format_are_not_lost_without_a_word(tmp_path, rng):
    (tmp_path / "sand").mkdir()
    image = rng.integers(0, 256, (80, 90)).astype(np.uint8)
    cv2.imwrite(f"{tmp_path / 'sand/a'}.png", image)
    assert not said(tmp_path)
    (tmp_path / "sand/b.webp").write_bytes(b"an image")
    (note,) = said(tmp_path)
    assert note.startswith("Note: not read: 1 image beside 1 photograph, such as")


def test_a_terrain_by_a_camera_of_its_own_is_named(tmp_path, rng):
    for terrain, quality in {"mud": 50, "sand": 90, "tile": 90}.items():
        (tmp_path / terrain).mkdir()
        for photo in range(5):
            image = rng.integers(0, 256, (80, 80)).astype(np.uint8)
            file = f"{tmp_path / terrain / str(photo)}.jpg"
            cv2.imwrite(file, image, [cv2.IMWRITE_JPEG_QUALITY, quality])
    (note,) = said(tmp_path)
    assert "no other terrain have: mud (JPEG compression: 5 of 5). " in note


def test_a_terrain_by_a_blurred_camera_is_named(tmp_path, rng):
    for terrain in ("mud", "sand", "tile"):
        (tmp_path / terrain).mkdir()
        for photo in range(5):
            image = np.clip(rng.normal(128, 30, (80, 80)), 0, 255).astype(np.uint8)
            shown = cv2.GaussianBlur(image, (0, 0), 1.5) if terrain == "mud" else image
            cv2.imwrite(f"{tmp_path / terrain / str(photo)}.png", shown)
    (note,) = said(tmp_path)
    assert "photographs of a terrain are unlike most of any other: mud (less sharp). " in note
    whole = (tmp_path / "mud" / "0.png").read_bytes()
    for photo in range(1, 4):  # two scenes are no five photographs
        (tmp_path / "mud" / f"{photo}.png").write_bytes(whole)
    (copies,) = said(tmp_path)
    assert "They are held out together" in copies
    assert "no test" not in copies
    (tmp_path / "mud" / "4.png").write_bytes(whole)
    assert any(note.endswith("All of mud would be one scene: no test") for note in said(tmp_path))


def test_grey_images_before_a_model_in_colour_are_counted(capsys):
    print_unnamed([COLOURLESS, "", COLOURLESS, SKY])
    said_of = capsys.readouterr().err
    assert "Note: 1 of 4 images show no terrain" in said_of
    assert "Note: 2 of 4 images have no name, since they are grey" in said_of
    print_unnamed(["", ""])
    assert capsys.readouterr().err == ""
