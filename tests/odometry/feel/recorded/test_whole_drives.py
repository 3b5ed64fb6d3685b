"""Parts of one drive count as one run: held out beside each other they are no test."""

from dataclasses import replace
from pathlib import Path

from odometry.feel.identify_feel import identify_feel
from odometry.feel.labels.files import sentences
from odometry.feel.labels.follow import follow_feel
from odometry.feel.recorded.whole_drives import PAUSE_S, drive_numbers, whole_drives
from odometry.feel.recorded.windows import feel_windows
from odometry.recording.run_span import Span, cut_run
from tests.odometry.feel.feel_drives import drive, table


def parts_of(run, *, folders=True, pause_s=0.0):
    """Both halves of a drive of 20 s, in folders of their own as files of a split bag give them."""
    halves = cut_run(run, Span(0.0, 10.0)), cut_run(run, Span(10.0 + pause_s, 20.0))
    if not folders:
        return list(halves)
    return [replace(one, folder=Path(f"{run.folder}_{i}")) for i, one in enumerate(halves)]


def later(run, seconds):
    """The same by a clock that began earlier."""
    tables = {
        name: table({**of.columns, "t": of["t"] + seconds})
        for name, of in (("odometry", run.odometry), ("imu", run.imu))
    }
    return replace(run, **tables)


def drive_of(terrain, seed):
    return later(drive(terrain, seed, seconds=20.0), 1000.0 * seed)


def numbers_of(runs):
    return drive_numbers(runs).tolist()


def test_parts_go_on_where_another_ends():
    one, other = parts_of(drive_of("tiles", 1))
    assert numbers_of([one, other]) == numbers_of([other, one]) == [0, 0]
    assert numbers_of(parts_of(drive_of("tiles", 1), pause_s=5.0)) == [0, 0]
    assert numbers_of([one, later(other, -0.5)]) == [0, 0]
    assert numbers_of([one, later(other, -5.0)]) == [0, 1]
    assert numbers_of([drive_of("tiles", 1), drive_of("tiles", 2)]) == [0, 1]


def test_a_drive_after_a_pause_is_another_one():
    one, other = parts_of(drive_of("tiles", 1))
    assert numbers_of([one, later(other, PAUSE_S + 1.0)]) == [0, 1]


def test_drives_that_all_begin_at_zero_are_not_mixed_up():
    runs = [part for seed in (1, 2) for part in parts_of(drive("tiles", seed, seconds=20.0))]
    assert numbers_of(runs) == [0, 1, 2, 3]
    of_folders = [
        part
        for seed in (1, 2)
        for part in parts_of(drive("tiles", seed, seconds=20.0), folders=False)
    ]
    assert numbers_of(of_folders) == [0, 0, 2, 2]


def test_parts_of_one_folder_are_one_drive_however_far_apart():
    first, last = parts_of(drive("tiles", 1, seconds=40.0), folders=False)
    far = cut_run(drive("tiles", 1, seconds=40.0), Span(30.0, 40.0))
    assert numbers_of([first, far]) == [0, 0]
    assert numbers_of([first, last, far]) == [0, 0, 0]


def test_parts_stay_runs_where_a_terrain_has_one_drive():
    gravel = [drive_of("gravel", 3), drive_of("gravel", 4)]
    runs = [*parts_of(drive_of("tiles", 1)), *gravel]
    windows = [feel_windows(run) for run in runs]
    drives = whole_drives(runs, windows)
    assert drives.of_one == ("tiles",)
    assert len(drives) == 4
    (note,) = drives.notes()
    assert note.startswith("All runs of tiles are parts of one drive")
    more = [*runs, drive_of("tiles", 2)]
    drives = whole_drives(more, [*windows, feel_windows(more[-1])])
    assert drives.numbers.tolist() == [0, 0, 1, 2, 3]
    assert drives.first.tolist() == [0, 2, 3, 4]
    (note,) = drives.notes()
    assert note.startswith("5 runs count as 4")


def test_a_model_is_judged_on_drives_and_not_on_their_parts():
    whole = [drive_of(*of) for of in (("tiles", 1), ("tiles", 2), ("gravel", 3), ("gravel", 4))]
    model = identify_feel([part for run in whole for part in parts_of(run)])
    assert model.report["run"]["answers"] == len(whole)
    assert any("8 runs count as 4" in note for note in model.report["notes"])
    assert model.report["one_drive"] == []


def test_answers_of_a_model_of_one_drive_say_so():
    runs = [*parts_of(drive_of("tiles", 1)), *parts_of(drive_of("gravel", 2))]
    model = identify_feel(runs)
    assert model.report["one_drive"] == ["gravel", "tiles"]
    said = sentences(follow_feel(drive_of("tiles", 9), model))
    assert any("felt gravel, tiles on one drive each" in one for one in said)
