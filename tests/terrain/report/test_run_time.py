"""Stamps since 1970: what a person reads counts from the start of the run."""

import shutil

import numpy as np
import pytest
from matplotlib.figure import Figure

from odometry.recording.run import Run
from odometry.recording.run_span import Span, cut_run
from odometry.report.drawing.figure import show_run_time
from terrain.cli.results import print_changes
from terrain.main_job import run_odometry
from terrain.report.page import write_report
from terrain.result.run_notes import event_lines, run_notes
from tests.terrain.report.page_reader import Reader

EPOCH_S = 1_700_000_000.25


@pytest.fixture(scope="module")
def epoch_result(across_run, classifier, tmp_path_factory):
    """The main job on a run whose stamps are seconds since 1970."""
    run = shutil.copytree(across_run, tmp_path_factory.mktemp("epoch") / "run")
    for file in run.glob("*.csv"):
        header, *rows = file.read_text().splitlines()
        moved = []
        for row in rows:
            stamp, rest = row.split(",", 1)
            moved.append(f"{float(stamp) + EPOCH_S:.9f},{rest}")
        file.write_text("\n".join([header, *moved]) + "\n")
    return run_odometry(run, model=classifier, terrain="gravel")


def test_the_page_counts_run_time_and_says_the_start_once(epoch_result, tmp_path):
    write_report(epoch_result, tmp_path)
    text = Reader(tmp_path / "report.html").text
    assert text.count("1700000") == 1
    assert "seconds since the first stamp of the run, 1700000000.250 s" in text
    header, rows = Reader(tmp_path / "report.html").table("in force [s]")
    first = float(rows[0][header.index("in force [s]")])
    assert first == pytest.approx(epoch_result.changes[0].stamp_s - EPOCH_S, abs=0.01)


def test_the_lines_of_the_verb_do_as_well(epoch_result, capsys):
    print_changes(epoch_result)
    said = capsys.readouterr().out
    assert f"from {epoch_result.changes[0].stamp_s - EPOCH_S:.1f} s boards" in said
    assert said.count("1700000") == 1
    assert "1700000" not in " ".join([*run_notes(epoch_result), *event_lines(epoch_result)])


def test_run_time_of_a_part_is_that_of_the_whole(across_run):
    run = Run.read(across_run)
    part = cut_run(cut_run(run, Span(1.0, 4.0)), Span(1.5, 3.0))
    assert part.began_s == run.began_s
    assert part.cut_s == pytest.approx(2.5)


def test_an_axis_has_round_times_of_the_run():
    figure = Figure(figsize=(7, 3))
    axes = figure.add_axes((0.1, 0.1, 0.8, 0.8))
    axes.plot(EPOCH_S + np.array([0.0, 60.0]), [0, 1])
    axes.margins(x=0.0)
    show_run_time(axes, EPOCH_S)
    figure.draw_without_rendering()
    shown = [label.get_text() for label in axes.get_xticklabels()]
    assert {"0", "20", "40", "60"} <= set(shown)
    assert axes.xaxis.get_offset_text().get_text() == ""
