"""What is said of the runs from which feel is learned."""

from dataclasses import replace

from odometry.feel.classifier.design import Design
from odometry.feel.classifier.table import FeelTable
from odometry.feel.identify_feel import notes_of
from odometry.feel.recorded.whole_drives import whole_drives
from odometry.feel.recorded.windows import feel_windows
from tests.odometry.feel.feel_drives import drive


def said(runs, top_hz=None):
    windows = [feel_windows(run, 2.0) for run in runs]
    if top_hz is not None:
        windows = [replace(one, top_hz=top) for one, top in zip(windows, top_hz, strict=True)]
    table, drives = FeelTable.of(windows, Design.shared(windows)), whole_drives(runs, windows)
    return tuple(notes_of(table, windows, drives, by_day=True))


def drives_at(rates_of):
    return [
        drive(terrain, 10 * i + j, rate_hz=rate_hz)
        for i, (terrain, rates_hz) in enumerate(rates_of.items())
        for j, rate_hz in enumerate(rates_hz)
    ]


def test_a_terrain_with_a_sampling_rate_of_its_own_is_named():
    rates_of = {"tiles": [100.0] * 3, "gravel": [50.0] * 3, "snow": [100.0, 200.0, 100.0]}
    (note,) = said(drives_at(rates_of))
    assert note.startswith("All runs of gravel were sampled 50 times a second, those of other")
    assert "terrains 100 to 200 times" in note


def test_one_run_at_the_rate_of_the_others_is_enough():
    assert said(drives_at({"tiles": [100.0] * 3, "gravel": [50.0, 50.0, 100.0]})) == ()


def test_rates_of_one_sensor_differ_a_little():
    runs = drives_at({"tiles": [100.0] * 3, "gravel": [100.0] * 3})
    assert said(runs, [50.0] * 3 + [52.0] * 3) == ()
    assert len(said(runs, [50.0] * 3 + [58.0] * 3)) == 2
