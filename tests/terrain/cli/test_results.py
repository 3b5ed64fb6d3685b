"""What the commands print of results."""

from types import SimpleNamespace

from odometry.outputs.manifest import Manifest
from terrain.cli.results import (
    error_cells,
    print_changes,
    print_errors,
    print_image_labels,
    print_table,
    print_written,
)
from terrain.main_job import run_odometry
from terrain.result.run_result import TerrainChange


def test_columns_line_up_words_to_the_left_numbers_to_the_right(capsys):
    print_table([("", "m", "by"), ("a", "0.25", "pose"), ("long name", "10.5", "-")])
    assert capsys.readouterr().out.splitlines() == [
        "                m  by",
        "  a          0.25  pose",
        "  long name  10.5  -",
    ]


def test_cells_hold_the_means_and_a_dash_where_there_is_none():
    errors = {
        "translation_m_per_m": {"mean": 0.01234, "quartiles": [0.005, 0.01, 0.02]},
        "rotation_deg_per_m": {"mean": None, "quartiles": None},
        "position_m": {"mean": 1.0, "final": 2.0},
    }
    cells = ["0.0123", "0.0100", "-", "-", "1.0000", "-", "2.0000"]
    assert error_cells(errors) == cells


def test_errors_are_those_of_the_scores_and_name_the_reference(curvy_run, capsys):
    result = run_odometry(curvy_run)
    print_errors({"a run": result})
    lines = capsys.readouterr().out.splitlines()
    assert "against pose.csv" in lines[0]
    assert "5 m of wheel travel" in lines[0]
    rows = {line.split("  ")[1]: line.split()[-1] for line in lines[2:5]}
    assert set(rows) == {"a run: odometer", "a run: differential_drive", "a run: estimate"}
    assert lines[5].startswith("The estimate is evaluated with 6 poses, one every 2 s")
    assert lines[6].startswith("The run has no gyroscope")
    for name, score in result.scores.items():
        assert rows[f"a run: {name}"] == f"{score.final_position_m:.4f}"


def test_files_are_named_within_their_folder(tmp_path, capsys):
    Manifest("run", "finished", ("figures/a.png", "result.json")).write(tmp_path)
    print_written(tmp_path)
    assert capsys.readouterr().out == (
        f"Wrote to {tmp_path}: figures/a.png, result.json, terrain-odometry.json\n"
    )


def test_images_are_counted_by_what_they_said(capsys):
    print_image_labels({"mud": 12, "no label: the robot is stationary": 3})
    assert capsys.readouterr().out == "Images: 12 mud, 3 no label: the robot is stationary\n"
    print_image_labels({})
    assert capsys.readouterr().out == ""


def told(stamps_s, source="labels"):
    changes = [TerrainChange(f"t{k}", stamp_s) for k, stamp_s in enumerate(stamps_s)]
    run = SimpleNamespace(began_s=0.0)
    return SimpleNamespace(
        source=source, initial_terrain="ice", changes_and_unknown=changes, run=run
    )


def test_the_terrain_in_force_is_printed_with_its_times(capsys):
    print_changes(told([1.0, 2.04]))
    assert capsys.readouterr().out == "Terrain in force: ice, from 1.0 s t0, from 2.0 s t1\n"
    print_changes(told(range(9)))
    assert "from 5.0 s t5, 3 more changes, see terrain.csv\n" in capsys.readouterr().out
    print_changes(told([], source="none"))
    assert capsys.readouterr().out == ""
