import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.io.csv_table import write_csv_table
from terrain.classification.photographs.patches import (
    cut_patches,
    find_photos,
    fitting_side_px,
    load_patches,
    stated_metres_per_pixel,
)
from terrain.errors import ImageError, PatchError
from terrain.labelling.corrections import Corrections, read_corrections


def photo(path, size=(40, 50), seed=0):
    path.parent.mkdir(parents=True, exist_ok=True)
    image = np.random.default_rng(seed).integers(0, 256, (*size, 3), dtype=np.uint8)
    assert cv2.imwrite(str(path), image)


@given(st.integers(1, 40), st.integers(1, 40), st.integers(1, 12), st.none() | st.integers(1, 12))
def test_patches_lie_on_a_centred_grid_that_cannot_be_extended(rows, columns, size, stride):
    image = np.arange(rows * columns).reshape(rows, columns)
    patches = cut_patches(image, size, stride)
    if rows < size or columns < size:
        assert patches == []
        return
    tops = sorted({int(patch[0, 0]) // columns for patch in patches})
    lefts = sorted({int(patch[0, 0]) % columns for patch in patches})
    assert len(patches) == len(tops) * len(lefts)
    for starts, length in ((tops, rows), (lefts, columns)):
        before, after = starts[0], length - starts[-1] - size
        assert 0 <= after - before <= 1
        assert before + after < (stride or size)
        assert set(np.diff(starts)) <= {stride or size}
    assert all(patch.shape == (size, size) for patch in patches)


def test_photo_ids_of_a_manifest_group_and_other_photos_stand_alone(tmp_path):
    for name in ("grass/a.jpg", "grass/b.PNG", "sand/c.png", "sand/d.png"):
        photo(tmp_path / "set" / name)
    (tmp_path / "set/grass/notes.txt").write_text("no photo")
    manifest = "photo_id,path\nlook,set/grass/a.jpg\nlook,set/grass/b.PNG\nother,set/sand/c.png\n"
    (tmp_path / "manifest.csv").write_text(manifest)
    photos = find_photos(tmp_path / "set")
    assert [p.label for p in photos] == ["grass", "grass", "sand", "sand"]
    groups = [p.group for p in photos]
    assert groups[:3] == ["look", "look", "other"]
    assert groups[3] not in groups[:3]


@pytest.mark.parametrize(("told", "moved"), [("@dry", {"a.jpg": "=wet"}), ("=wet", {})])
def test_names_that_were_quoted_for_spreadsheets_are_found(tmp_path, told, moved):
    photo(tmp_path / "=wet" / "a.jpg")
    cells = {"path": "=wet/a.jpg", "photo_id": "-look", "told": told}
    columns = {name: np.array([cell]) for name, cell in cells.items()}
    write_csv_table(tmp_path / "manifest.csv", columns)
    assert [(p.label, p.group) for p in find_photos(tmp_path)] == [("=wet", "-look")]
    assert read_corrections(tmp_path) == Corrections(moved)


def test_the_folders_own_manifest_goes_before_its_parents(tmp_path):
    photo(tmp_path / "set/grass/a.jpg")
    (tmp_path / "manifest.csv").write_text("path,photo_id\nset/grass/a.jpg,parent\n")
    (tmp_path / "set/manifest.csv").write_text("path,photo_id\ngrass/a.jpg,own\n")
    assert [p.group for p in find_photos(tmp_path / "set")] == ["own"]


def test_a_parents_manifest_of_other_folders_says_nothing(tmp_path):
    for name in ("street/grass/a.jpg", "set/grass/b.jpg"):
        photo(tmp_path / name)
    manifest = tmp_path / "manifest.csv"
    manifest.write_text("path,photo_id,metres_per_pixel\nset/grass/b.jpg,look,0.002\n")
    (of_street,) = find_photos(tmp_path / "street")
    assert of_street.group == str(tmp_path / "street/grass/a.jpg")
    assert stated_metres_per_pixel(tmp_path / "street") is None
    assert [p.group for p in find_photos(tmp_path / "set")] == ["look"]
    assert stated_metres_per_pixel(tmp_path / "set") == 0.002


@pytest.mark.parametrize("path", ["grass/a.jpg", "old_name/grass/a.jpg", "set\\grass\\a.jpg"])
def test_a_parents_manifest_with_the_names_of_photographs_must_lead_to_them(tmp_path, path):
    photo(tmp_path / "set/grass/a.jpg")
    (tmp_path / "manifest.csv").write_text(f"path,photo_id\n{path},look\n")
    with pytest.raises(PatchError, match=r"manifest\.csv: none of its 1 paths"):
        find_photos(tmp_path / "set")


def test_hidden_files_are_no_photographs(tmp_path):
    for name in ("grass/a.jpg", "grass/._a.jpg", ".thumbnails/a.jpg", ".a.jpg"):
        photo(tmp_path / name)
    assert [p.path for p in find_photos(tmp_path)] == [tmp_path / "grass/a.jpg"]
    photo(tmp_path / ".hidden_root/sand/b.jpg")
    assert [p.label for p in find_photos(tmp_path / ".hidden_root")] == ["sand"]


def test_a_manifest_without_photo_id_groups_nothing(tmp_path):
    photo(tmp_path / "grass/a.jpg")
    photo(tmp_path / "grass/b.jpg")
    (tmp_path / "manifest.csv").write_text("path,class\ngrass/a.jpg,grass\ngrass/b.jpg,grass\n")
    assert len({p.group for p in find_photos(tmp_path)}) == 2


def test_folders_that_hold_no_classes_are_errors(tmp_path):
    with pytest.raises(PatchError, match="not a folder"):
        find_photos(tmp_path / "absent")
    with pytest.raises(PatchError, match="no photographs"):
        find_photos(tmp_path)


@pytest.mark.parametrize("name", ["unknown", "unknown 1", "Unknown_12"])
def test_a_name_of_what_is_unknown_is_no_class(tmp_path, name):
    photo(tmp_path / f"{name}/a.jpg")
    photo(tmp_path / "unknown sand/a.jpg")
    with pytest.raises(PatchError, match=f"'{name}' is reserved"):
        find_photos(tmp_path)


def test_loaded_patches_overlap_by_half_and_are_capped_evenly(tmp_path):
    photo(tmp_path / "grass/large.png", size=(40, 50))
    photo(tmp_path / "grass/small.png", size=(15, 50))
    photos = find_photos(tmp_path)
    loaded = load_patches(photos, 16)
    assert len(loaded.images) == 4 * 5  # starts 0, 8, 16, 24 and 1, 9, ..., 33
    assert loaded.too_small == [tmp_path / "grass/small.png"]
    assert set(loaded.labels) == {"grass"}
    assert set(loaded.photos) == {tmp_path / "grass/large.png"}
    capped = load_patches(photos, 16, max_per_photo=3)
    np.testing.assert_array_equal(capped.images, [loaded.images[i] for i in (0, 9, 19)])


def test_a_class_without_a_patch_and_a_broken_photo_are_errors(tmp_path):
    photo(tmp_path / "grass/a.png")
    photo(tmp_path / "sand/a.png", size=(15, 15))
    with pytest.raises(PatchError, match=r"'sand'.*1 photographs.*16 x 16"):
        load_patches(find_photos(tmp_path), 16)
    (tmp_path / "sand/b.png").write_bytes(b"no image")
    with pytest.raises(ImageError, match=r"b\.png"):
        load_patches(find_photos(tmp_path), 16)


def test_the_patch_size_fits_nine_of_ten_photographs(tmp_path):
    folder = tmp_path / "gravel"
    folder.mkdir()
    for i, side in enumerate([20, 70, 80, *[90] * 8]):
        cv2.imwrite(str(folder / f"{i:02d}.png"), np.zeros((side, side + 5), np.uint8))
    assert fitting_side_px(find_photos(tmp_path)) == 70


def test_the_scale_is_what_the_manifest_states(tmp_path):
    manifest = tmp_path / "manifest.csv"
    assert stated_metres_per_pixel(tmp_path) is None
    manifest.write_text("path,photo_id,metres_per_pixel\na/1.jpg,1,0.003\na/2.jpg,2,\n")
    assert stated_metres_per_pixel(tmp_path) == 0.003
    for cells in ("0.003\na/2.jpg,2,0.004", "fine", "-1", "inf"):
        manifest.write_text(f"path,photo_id,metres_per_pixel\na/1.jpg,1,{cells}\n")
        with pytest.raises(PatchError, match=r"manifest\.csv: metres_per_pixel"):
            stated_metres_per_pixel(tmp_path)


def test_a_manifest_saved_by_a_spreadsheet_groups_too(tmp_path):
    photo(tmp_path / "grass/a.jpg")
    photo(tmp_path / "grass/b.jpg")
    text = "path,photo_id\ngrass/a.jpg,1\ngrass/b.jpg,1\n"
    (tmp_path / "manifest.csv").write_text(text, encoding="utf-8-sig")
    assert len({p.group for p in find_photos(tmp_path)}) == 1


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (b"grass/a.jpg,\n", "row 2, column 'photo_id'"),
        (b"grass/a.jpg\n", "row 2: 1 cells"),
        (b"gr\xfcn/a.jpg,1\n", "cannot be read"),
        (b"", "it is empty"),
        (b"grass/\0a.jpg,1\n", "row 2 holds a NUL byte"),
        (b"../a.jpg,1\n", r"row 2, column 'path': '\.\./a\.jpg' leads out"),
    ],
)
def test_a_manifest_with_holes_is_an_error(tmp_path, rows, message):
    photo(tmp_path / "grass/a.jpg")
    (tmp_path / "manifest.csv").write_bytes(b"path,photo_id\n" + rows)
    with pytest.raises(PatchError, match=message):
        find_photos(tmp_path)


def test_patches_do_not_keep_their_photographs(tmp_path):
    photo(tmp_path / "grass/a.jpg", (64, 64))
    patches = load_patches(find_photos(tmp_path), 16)
    assert all(patch.base is None for patch in patches.images)


def test_a_manifest_that_names_no_photograph_is_an_error(tmp_path):
    photo(tmp_path / "set/grass/a.jpg")
    (tmp_path / "set/manifest.csv").write_text("path,photo_id\nset/grass/a.jpg,1\nb.jpg,1\n")
    with pytest.raises(PatchError, match=r"manifest\.csv: none of its 2 paths") as error:
        find_photos(tmp_path / "set")
    for path in ("set/set/grass/a.jpg", "set/grass/a.jpg"):
        assert str(tmp_path / path) in str(error.value)


def test_a_manifest_may_not_name_what_lies_outside(tmp_path):
    photo(tmp_path / "outside.jpg")
    photo(tmp_path / "set/grass/a.jpg")
    (tmp_path / "set/grass/link.jpg").symlink_to(tmp_path / "outside.jpg")
    for row in ("../outside.jpg", "grass/link.jpg", "/etc/hostname"):
        (tmp_path / "set/manifest.csv").write_text(f"path,photo_id\ngrass/a.jpg,1\n{row},2\n")
        with pytest.raises(PatchError, match=r"manifest\.csv: row 3, column 'path': .*leads out"):
            find_photos(tmp_path / "set")


def test_an_empty_manifest_is_an_error_and_one_of_something_else_is_not(tmp_path):
    photo(tmp_path / "grass/a.jpg")
    (tmp_path / "manifest.csv").touch()
    for content in ("", "path,photo_id\n", "\n\n"):
        (tmp_path / "manifest.csv").write_text(content)
        with pytest.raises(PatchError, match="it is empty"):
            stated_metres_per_pixel(tmp_path)
    (tmp_path / "manifest.csv").write_text("a,b\n1,2,3\n")
    assert stated_metres_per_pixel(tmp_path) is None
    assert len(find_photos(tmp_path)) == 1


def test_a_moved_file_keeps_its_group(tmp_path):
    for path in ("grass/a.png", "grass/b.png", "sand/c.png", "sand/a_copy.png"):
        (tmp_path / path).parent.mkdir(exist_ok=True)
        assert cv2.imwrite(str(tmp_path / path), np.zeros((8, 8), np.uint8))
    (tmp_path / "manifest.csv").write_text(
        "path,photo_id\ngrass/a.png,one\ngrass/b.png,two\nsand/c.png,three\n"
    )
    (tmp_path / "grass/b.png").rename(tmp_path / "sand/b.png")
    groups = {photo.path.name: (photo.label, photo.group) for photo in find_photos(tmp_path)}
    own = str(tmp_path / "sand/a_copy.png")
    assert groups == {
        "a.png": ("grass", "one"),
        "b.png": ("sand", "two"),
        "c.png": ("sand", "three"),
        "a_copy.png": ("sand", own),
    }


def test_a_name_that_several_rows_have_is_no_moved_file(tmp_path):
    for path in ("grass/1.png", "moss/1.png"):
        (tmp_path / path).parent.mkdir(exist_ok=True)
        assert cv2.imwrite(str(tmp_path / path), np.zeros((8, 8), np.uint8))
    (tmp_path / "manifest.csv").write_text("path,photo_id\ngrass/1.png,one\nsand/1.png,two\n")
    groups = [photo.group for photo in find_photos(tmp_path)]
    assert groups == ["one", str(tmp_path / "moss/1.png")]
