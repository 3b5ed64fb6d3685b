import hashlib
import io
import json
import pickle
import shutil
import zipfile

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from terrain.classification.model_file import read_model, write_model
from terrain.errors import ModelFileError

SETTINGS = {"preset": "default", "classes": ["grass", "sand"], "scale": None, "k": 5}
ARRAYS = {"points": np.arange(12.0).reshape(4, 3) / 7, "codes": np.array([0, 1, 1, 0])}


@pytest.fixture
def file(tmp_path):
    write_model(tmp_path / "a.model", SETTINGS, ARRAYS)
    return tmp_path / "a.model"


def rewritten(file, change):
    """The members of a model file after `change`, under their proper checksums."""
    with zipfile.ZipFile(file) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    header = json.loads(members.pop("header.json"))
    members.pop("sha256")
    change(header, members)
    header["sha256"] = {name: hashlib.sha256(data).hexdigest() for name, data in members.items()}
    text = json.dumps(header).encode()
    members |= {"header.json": text, "sha256": hashlib.sha256(text).hexdigest().encode()}
    with zipfile.ZipFile(file, "w") as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return file


def assert_refused(file, match):
    with pytest.raises(ModelFileError, match=match) as caught:
        read_model(file)
    assert str(file) in str(caught.value)


def test_settings_and_arrays_come_back_exactly(file):
    settings, arrays = read_model(file)
    assert settings == SETTINGS
    assert set(arrays) == set(ARRAYS)
    for name, array in ARRAYS.items():
        assert arrays[name].dtype == array.dtype
        np.testing.assert_array_equal(arrays[name], array)
    with np.load(file, allow_pickle=False) as other:
        np.testing.assert_array_equal(other["points"], ARRAYS["points"])


def test_the_same_content_gives_the_same_bytes(file, tmp_path):
    backwards = [dict(reversed(table.items())) for table in (SETTINGS, ARRAYS)]
    write_model(tmp_path / "b.model", *backwards)
    assert (tmp_path / "b.model").read_bytes() == file.read_bytes()


@given(data=st.data())
def test_a_changed_byte_is_noticed_or_harmless(tmp_path_factory, data):
    file = tmp_path_factory.getbasetemp() / "byte.model"
    write_model(file, SETTINGS, ARRAYS)
    whole = bytearray(file.read_bytes())
    position = data.draw(st.integers(0, len(whole) - 1))
    whole[position] ^= data.draw(st.integers(1, 255))
    file.write_bytes(whole)
    try:
        settings, arrays = read_model(file)
    except ModelFileError:
        return
    assert settings == SETTINGS
    assert all((arrays[name] == ARRAYS[name]).all() for name in ARRAYS)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.6, 0.99])
def test_a_cut_file_is_refused(file, share):
    whole = file.read_bytes()
    file.write_bytes(whole[: int(share * len(whole))])
    assert_refused(file, "cannot be read as a model file")


def test_missing_and_foreign_files_are_refused(tmp_path):
    assert_refused(tmp_path / "absent.model", "cannot be read")
    (tmp_path / "text.model").write_text("not a zip")
    assert_refused(tmp_path / "text.model", "cannot be read")
    with zipfile.ZipFile(tmp_path / "zip.model", "w") as archive:
        archive.writestr("readme.txt", "a zip of somebody else")
    assert_refused(tmp_path / "zip.model", "not a model file")
    np.savez(tmp_path / "arrays.npz", np.zeros(3))
    assert_refused(tmp_path / "arrays.npz", "not a model file")


def test_other_formats_and_newer_versions_are_named(file):
    assert_refused(
        rewritten(file, lambda header, _: header.update(version=2)),
        "newer version.*format 2.*up to 1",
    )
    assert_refused(rewritten(file, lambda header, _: header.update(format="other")), "does not say")


@pytest.mark.parametrize("header", ["[]", '{"format": 1}', "{", "null", "[" * 100_000])
def test_headers_of_another_kind_are_refused(file, header):
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("header.json", header)
    assert_refused(file, "not a model file")


@pytest.mark.parametrize("table", ["settings", "sha256"])
def test_headers_without_their_tables_are_refused(file, table):
    with zipfile.ZipFile(file) as archive:
        header = json.loads(archive.read("header.json"))
    text = json.dumps(header | {table: 7}).encode()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("header.json", text)
        archive.writestr("sha256", hashlib.sha256(text).hexdigest())
    assert_refused(file, f"'{table}'")


def test_added_and_lost_members_are_refused(file):
    stream = io.BytesIO()
    np.save(stream, np.zeros(2))
    added = file.with_name("added.model")
    shutil.copy(file, added)
    with zipfile.ZipFile(added, "a") as archive:
        archive.writestr("more.npy", stream.getvalue())
    assert_refused(added, "holds .*more")
    with zipfile.ZipFile(file) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    with zipfile.ZipFile(file, "w") as archive:
        for name in set(members) - {"codes.npy"}:
            archive.writestr(name, members[name])
    assert_refused(file, "expected .*codes")


def test_an_exchanged_array_is_noticed(file, tmp_path):
    """The zip is whole: only the checksum shows it."""
    write_model(tmp_path / "other.model", SETTINGS, ARRAYS | {"points": -ARRAYS["points"]})
    with zipfile.ZipFile(file) as one, zipfile.ZipFile(tmp_path / "other.model") as other:
        members = {name: one.read(name) for name in one.namelist()}
        members["points.npy"] = other.read("points.npy")
    with zipfile.ZipFile(file, "w") as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    assert_refused(file, r"checksum of points\.npy does not agree")


def test_nothing_is_unpickled(file, tmp_path):
    trap = tmp_path / "executed"

    class Trap:
        def __reduce__(self):
            return open, (str(trap), "w")

    stream = io.BytesIO()
    np.save(stream, np.array([Trap()], dtype=object), allow_pickle=True)
    assert_refused(
        rewritten(file, lambda _, members: members.update({"points.npy": stream.getvalue()})),
        r"points\.npy",
    )
    assert_refused(
        rewritten(file, lambda _, m: m.update({"points.npy": pickle.dumps(Trap())})),
        r"points\.npy is not an array",
    )
    pointers = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        pointers, {"descr": "|O", "fortran_order": False, "shape": (2,)}
    )
    assert_refused(
        rewritten(file, lambda _, m: m.update({"points.npy": pointers.getvalue() + bytes(16)})),
        "of object",
    )
    assert not trap.exists()


def test_absurd_sizes_are_refused_before_they_are_filled(file, tmp_path):
    bomb = tmp_path / "bomb.model"
    with zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("header.json", b" " * 50_000_000)
    assert_refused(bomb, "claim 50000000 bytes")
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        stream, {"descr": "<f8", "fortran_order": False, "shape": (10**6, 10**6)}
    )
    assert_refused(
        rewritten(file, lambda _, members: members.update({"points.npy": stream.getvalue()})),
        "claims",
    )
    whole = bytearray(file.read_bytes())
    entry = whole.rindex(b"PK\x01\x02")
    whole[entry + 24 : entry + 28] = (2**31).to_bytes(4, "little")
    file.write_bytes(whole)
    assert_refused(file, "claim 2147")


def test_overlapping_members_cannot_add_up_to_more_than_the_file(file):
    """Many directory entries for the same bytes."""
    whole = file.read_bytes()
    start = whole.index(b"PK\x01\x02")
    end = whole.rindex(b"PK\x05\x06")
    directory, tail = whole[start:end] * 50, bytearray(whole[end:])
    count = int.from_bytes(tail[8:10], "little") * 50
    tail[8:10] = tail[10:12] = count.to_bytes(2, "little")
    tail[12:16] = len(directory).to_bytes(4, "little")
    file.write_bytes(whole[:start] + directory + tail)
    assert_refused(file, "stores them uncompressed")


def test_packed_members_are_refused(file):
    """A member that unpacks to more than the file has is a bomb; this one has 100 MB of zeros."""
    with zipfile.ZipFile(file, "a", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("zeros.npy", bytes(100_000_000))
    assert_refused(file, "claim .* bytes, the file has")


@pytest.mark.parametrize("odd", [np.nan, np.inf])
def test_numbers_that_are_not_finite_are_refused(tmp_path, odd):
    write_model(tmp_path / "a.model", SETTINGS, ARRAYS | {"points": np.array([0.0, odd])})
    assert_refused(tmp_path / "a.model", "points.npy holds numbers that are not finite")


def test_an_array_header_that_does_not_end_is_refused(file):
    """numpy's own reader of headers lets an error of the tokenizer through."""

    def cut(_, members):
        members["points.npy"] = members["points.npy"].replace(b"(4, 3), }", b"(4, 3), (")

    assert_refused(rewritten(file, cut), "points.npy is not an array")
