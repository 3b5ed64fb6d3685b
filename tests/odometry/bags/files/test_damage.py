"""Damaged, truncated, empty and foreign files: what can be read is read, what was lost is said."""

import shutil
import zlib

import numpy as np
import pytest

from odometry.bags.files.bag_files import bag_files
from odometry.bags.files.damage import Losses
from odometry.bags.files.message_types import MessageTypes
from odometry.bags.topics.survey import survey
from odometry.errors import BagError
from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import KINDS, RADIUS_M, Bag, course, name_of

COURSE = np.array(list(course(40.0)))
JOINTS = ["left_wheel", "right_wheel"]
PLAIN = ("ros1", "sqlite3", "mcap")


@pytest.fixture(scope="module")
def bag_file(tmp_path_factory):
    """A copy of the one file of a bag of a kind."""
    made = {}

    def copy(kind, folder):
        if kind not in made:
            made[kind] = bag_of_many_chunks(kind, tmp_path_factory.mktemp(kind))
        shutil.copy(made[kind], folder)
        return folder / made[kind].name

    return copy


def bag_of_many_chunks(kind, folder):
    """The one file of a bag that holds wheels, and noise that spreads it over many chunks."""
    bag = Bag(kind)
    noise = np.random.default_rng(3)
    for t_s, left, right, *_ in COURSE:
        bag.joints(t_s, JOINTS, np.zeros(2), [left / RADIUS_M, right / RADIUS_M])
        bag.image(t_s, noise.integers(0, 256, (40, 60), dtype=np.uint8), "mono8")
    path = bag.write(folder / name_of(kind))
    return path if path.is_file() else next(f for f in path.iterdir() if f.suffix != ".yaml")


def true_rows(run):
    """How many rows came through; each has to be one that was written."""
    rows = np.round((run.odometry["t"] - run.odometry["t"][0]) * 20).astype(int)
    begin = np.argmin(np.abs(COURSE[:, 1] - run.odometry["v_left"][0]))
    assert run.odometry.stack("v_left", "v_right") == pytest.approx(
        COURSE[begin + rows, 1:3], abs=1e-7
    )
    return len(rows)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("share", [0.35, 0.95])
def test_a_file_that_was_cut_is_read_up_to_the_cut(kind, share, bag_file, tmp_path):
    file = bag_file(kind, tmp_path)
    content = file.read_bytes()
    cut = tmp_path / f"cut{file.suffix}"
    cut.write_bytes(content[: round(share * len(content))])
    if kind == "ros1_bz2" and share < 0.9:
        pytest.skip("a block of bzip2 holds 900 kB, which are lost together")
    run, said = imported(tmp_path / "run", cut, images__topic="none")
    assert true_rows(run) > 0.8 * share * len(COURSE)
    assert any(str(cut) in line for line in said.losses)


@pytest.mark.parametrize("kind", ["ros1", "ros1_lz4", "sqlite3", "mcap", "mcap_zstd"])
def test_bytes_that_are_overwritten_lose_what_is_around_them(kind, bag_file, tmp_path):
    file = bag_file(kind, tmp_path)
    content = bytearray(file.read_bytes())
    middle = len(content) // 2
    content[middle : middle + 6000] = bytes(6000)
    file.write_bytes(content)
    run, said = imported(tmp_path / "run", file, images__topic="none")
    assert true_rows(run) > 0.4 * len(COURSE)
    assert len(said.losses) > 0


def test_a_ros1_bag_is_read_on_behind_a_damaged_record(bag_file, tmp_path):
    """Chunks behind the damage are found by their headers."""
    file = bag_file("ros1", tmp_path)
    content = bytearray(file.read_bytes())
    chunk = content.index(b"op=\x05", len(content) // 3)
    content[chunk - 8 : chunk + 8] = b"\xff" * 16
    file.write_bytes(content)
    run, said = imported(tmp_path / "run", file, images__topic="none")
    assert true_rows(run) > 0.5 * len(COURSE)
    assert run.odometry["t"][-1] - run.odometry["t"][0] > 35
    assert any("bytes from byte" in line for line in said.losses)


def looked_at(*paths):
    losses = Losses()
    return survey(bag_files(paths, losses), MessageTypes(), losses, lambda _: None)


@pytest.mark.parametrize("content", [b"", b"hello", b"#ROSBAG V1.2\n", bytes(5000)])
def test_what_is_no_bag_is_said(content, tmp_path):
    file = tmp_path / "drive.bag"
    file.write_bytes(content)
    with pytest.raises(BagError, match=r"the file is empty|this is no bag"):
        looked_at(file)


@pytest.mark.parametrize("kind", PLAIN)
def test_a_bag_without_messages_is_said(kind, tmp_path):
    path = Bag(kind).write(tmp_path / name_of(kind))
    with pytest.raises(BagError, match="there is no message"):
        looked_at(path)


def test_a_missing_part_of_a_split_bag_is_named(tmp_path):
    folder = bag_of_many_chunks("sqlite3", tmp_path).parent
    metadata = folder / "metadata.yaml"
    text = metadata.read_text()
    metadata.write_text(text.replace("  - drive.db3", "  - drive.db3\n  - drive_1.db3"))
    assert any("drive_1.db3: it is missing" in line for line in looked_at(folder).losses)


def test_a_type_that_nobody_defines_is_said_and_the_rest_is_read(tmp_path):
    bag = Bag("mcap")
    bag.define("my_robot/msg/Secret", "float64 value\n")
    for t_s, left, right, *_ in COURSE[:50]:
        bag.joints(t_s, JOINTS, np.zeros(2), [left, right])
        bag.add(
            "/secret", "my_robot/msg/Secret", t_s, bag.message("my_robot/msg/Secret", value=t_s)
        )
    folder = bag.write(tmp_path / "drive")
    (file,) = folder.glob("*.mcap")
    content = file.read_bytes()
    file.write_bytes(content.replace(b"float64 value", b"Unknown value"))
    found = looked_at(file)
    assert "has no definition of my_robot/msg/Unknown" in found.topics["/secret"].problem
    assert found.topics["/joint_states"].problem == ""


def test_repeated_stamps_are_dropped_and_counted(tmp_path):
    bag = Bag("mcap")
    for t_s, left, right, *_ in COURSE:
        for later in (0.0, 0.01):
            speeds = [left / RADIUS_M, right / RADIUS_M]
            bag.joints(t_s + later, JOINTS, np.zeros(2), speeds, stamp_s=t_s)
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert true_rows(run) == len(COURSE)
    assert said.rows["odometry.csv"] == (len(COURSE), "/joint_states")
    assert any("800 messages repeat the stamp" in line for line in said.losses)


def test_rows_a_little_out_of_order_are_sorted(tmp_path):
    bag, noise = Bag("mcap"), np.random.default_rng(1)
    for t_s, left, right, *_ in COURSE:
        late = t_s + noise.uniform(0, 0.5)
        values = [left / RADIUS_M, right / RADIUS_M]
        bag.joints(late, JOINTS, np.zeros(2), values, stamp_s=t_s)
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert true_rows(run) == len(COURSE)
    assert said.losses == ()


def test_a_clock_that_is_set_back_is_said(tmp_path):
    """The second half of 4000 messages has stamps 60 s before the first ones."""
    bag = Bag("mcap")
    for number in range(4000):
        t_s = number / 50
        stamp = t_s if number < 2000 else t_s - 100
        bag.joints(t_s, JOINTS, np.zeros(2), [1.0, 1.0], stamp_s=stamp)
    path = bag.write(tmp_path / "drive")
    _, said = imported(tmp_path / "run", path, time="header")
    (line,) = said.losses
    assert "2000 messages have stamps that had been there" in line
    assert "--time log" in line
    again, said = imported(tmp_path / "again", path, time="log")
    assert len(again.odometry) == 4000
    assert said.losses == ()
    chosen, said = imported(tmp_path / "chosen", path)
    assert len(chosen.odometry) == 4000
    assert any("stamps of /joint_states go back by 99" in note for note in said.notes)


def test_stamps_of_unlike_clocks_give_way_to_the_times_of_reception(tmp_path):
    bag = Bag("mcap")
    for t_s, left, right, x, y, _ in COURSE:
        bag.joints(t_s, JOINTS, np.zeros(2), [left, right])
        bag.pose_stamped("/mocap/pose", t_s, bag.pose((x, y, 0), (1, 0, 0, 0)))
        bag.written[-1][3].header.stamp = bag.time(t_s - 1000)
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert run.pose["t"] == pytest.approx(run.odometry["t"], abs=1e-6)
    assert any("clocks of header stamps differ by 1e+03 s" in note for note in said.notes)


@pytest.mark.parametrize("damaged", [False, True])
def test_a_chunk_whose_check_sum_differs_is_left_out(damaged, bag_file, tmp_path):
    """The sum is put in here: the writer of the other tests leaves it out."""
    file = bag_file("mcap", tmp_path)
    content = bytearray(file.read_bytes())
    place = 8
    while content[place] != 6:  # the first chunk
        place += 9 + int.from_bytes(content[place + 1 : place + 9], "little")
    length = int.from_bytes(content[place + 1 : place + 9], "little")
    begin, end = place + 9 + 40, place + 9 + length  # of what the chunk holds, not compressed
    content[place + 33 : place + 37] = zlib.crc32(content[begin:end]).to_bytes(4, "little")
    content[end - 100] ^= damaged
    file.write_bytes(content)
    found = looked_at(file)
    assert any("check sum differs" in line for line in found.losses) == damaged
    assert (found.topics["/joint_states"].count < len(COURSE)) == damaged
