"""`import RUN --pose FILE.csv`: latitude and longitude as the positions of a run."""

import shutil

import numpy as np
import pytest
from click.testing import CliRunner

from odometry.errors import OdometryError
from odometry.recording.run import Run
from terrain.cli.main import cli
from tests.odometry.fixes.ellipsoid import place_of

pytest.importorskip("pymap3d")
ORIGIN = (48.1375, 11.575, 519.5)


@pytest.fixture
def run(tmp_path, curvy_run):
    """A run folder without poses, and the poses that it had."""
    folder = tmp_path / "run"
    shutil.copytree(curvy_run, folder)
    pose = Run.read(folder).pose
    (folder / "pose.csv").unlink()
    (folder / "truth.csv").unlink(missing_ok=True)
    return folder, pose


def fixes_of(pose, file, origin=ORIGIN, ahead_s=0.0):
    """A CSV file of the poses as degrees, by the definition of the ellipsoid."""
    begin = pose["x"][0], pose["y"][0]
    rows = ["Time [s],Latitude,Longitude,Altitude,hdop,fix_type"]
    for t, x, y in zip(pose.stamps_s + ahead_s, pose["x"], pose["y"], strict=True):
        place = place_of(x - begin[0], y - begin[1], 0.0, origin)
        rows.append(f"{t:.4f},{place[0]:.11f},{place[1]:.11f},{place[2]:.4f},0.9,3")
    file.write_text("\n".join(rows) + "\n")
    return file


def call(*arguments):
    return CliRunner().invoke(cli, ["import", *map(str, arguments)])


def test_places_become_metres_of_the_first_one(run, tmp_path):
    folder, pose = run
    before = (folder / "run.toml").read_text()
    answer = call(folder, "--pose", fixes_of(pose, tmp_path / "gnss.csv"))
    assert answer.exit_code == 0, answer.output
    found = Run.read(folder)
    np.testing.assert_allclose(found.pose["x"], pose["x"] - pose["x"][0], atol=1e-5)
    np.testing.assert_allclose(found.pose["y"], pose["y"] - pose["y"][0], atol=1e-5)
    assert np.isnan(found.pose["yaw"]).all()
    place = found.settings["source"]["origin"]
    origin = [place[name] for name in ("latitude", "longitude", "altitude")]
    assert origin == pytest.approx(ORIGIN)
    assert (folder / "run.toml").read_text().startswith(before.rstrip())
    for words in (
        "metres east and north of the first one: latitude 48.1375, longitude 11.575, altitude",
        "yaw is not measured",
        "stamps: 'Time [s]' in seconds",
        "run.toml: [source.origin] is that place",
        "those of an antenna",
        "Next: terrain-odometry identify",
    ):
        assert words in answer.output


def test_rows_without_a_fix_are_said(run, tmp_path):
    folder, pose = run
    file = fixes_of(pose, tmp_path / "gnss.csv")
    lines = file.read_text().splitlines()
    lines[5:9] = [line[: line.rindex(",")] + ",1" for line in lines[5:9]]
    file.write_text("\n".join(lines))
    answer = call(folder, "--pose", file)
    lost = f"Lost: {file}: 4 of {len(pose)} rows without a fix ('fix_type' says so), row 6 first"
    assert lost in answer.stderr
    assert len(Run.read(folder).pose) == len(pose) - 4


@pytest.mark.parametrize("form", ["list", "table"])
def test_an_origin_that_run_toml_states_is_taken(run, tmp_path, form):
    folder, pose = run
    north = place_of(0.0, 100.0, 0.0, ORIGIN)
    values = [float(value) for value in north]
    lines = {
        "list": f"[source]\norigin = {values}\n",
        "table": "[source.origin]\n"
        + "".join(
            f"{name} = {value!r}\n"
            for name, value in zip(("latitude", "longitude", "altitude"), values, strict=True)
        ),
    }
    with (folder / "run.toml").open("a") as stream:
        stream.write("\n" + lines[form])
    stated = (folder / "run.toml").read_text()
    answer = call(folder, "--pose", fixes_of(pose, tmp_path / "gnss.csv"))
    assert "of the origin in run.toml" in answer.output
    assert Run.read(folder).pose["y"][0] == pytest.approx(-100, abs=1e-3)
    assert (folder / "run.toml").read_text() == stated


def test_an_origin_elsewhere_is_an_error(run, tmp_path):
    folder, pose = run
    with (folder / "run.toml").open("a") as stream:
        stream.write("\n[source]\norigin = [10.0, 11.0]\n")
    answer = call(folder, "--pose", fixes_of(pose, tmp_path / "gnss.csv"))
    assert isinstance(answer.exception, OdometryError)
    assert "km from the origin that [source] of run.toml states" in str(answer.exception)
    assert not (folder / "pose.csv").exists()


def test_a_source_of_another_form_stays(run, tmp_path):
    folder, pose = run
    text = (folder / "run.toml").read_text()
    (folder / "run.toml").write_text('source = { of = "a friend" }\n' + text)
    answer = call(folder, "--pose", fixes_of(pose, tmp_path / "gnss.csv"))
    assert "run.toml is left as it was" in answer.output
    assert "origin" not in Run.read(folder).settings["source"]


def test_places_are_no_truth(run, tmp_path):
    folder, pose = run
    answer = call(folder, "--truth", fixes_of(pose, tmp_path / "gnss.csv"))
    assert "no yaw, which truth.csv needs; give --pose" in str(answer.exception)


@pytest.mark.parametrize(("hours", "said"), [(2, "-2 hours"), (-5.5, "+5.5 hours"), (24, "")])
def test_another_time_zone_is_said(run, tmp_path, hours, said):
    folder, pose = run
    answer = call(folder, "--pose", fixes_of(pose, tmp_path / "gnss.csv", ahead_s=hours * 3600))
    assert "expected stamps of one clock" in str(answer.exception)
    assert ("time zone" in str(answer.exception)) == bool(said)
    assert said in str(answer.exception)


def test_a_header_with_a_number_sign_is_no_trajectory(run, tmp_path):
    """Eight columns, four of them a quaternion of length 1: EuRoC but for the header."""
    folder, pose = run
    rows = ["#timestamp,latitude,longitude,altitude,fix_type,a,b,c"]
    rows += [
        f"{t * 1e9:.0f},{48 + y * 9e-6:.9f},{11 + x * 1.3e-5:.9f},500,1,0,0,0"
        for t, x, y in zip(pose.stamps_s, pose["x"], pose["y"], strict=True)
    ]
    file = tmp_path / "gnss.csv"
    file.write_text("\n".join(rows))
    answer = call(folder, "--pose", file)
    assert "no row has a fix" in str(answer.exception)


def test_latitude_and_longitude_in_pose_csv_have_a_way_in(run):
    folder, pose = run
    file = fixes_of(pose, folder / "pose.csv")
    file.write_text(file.read_text().replace("Time [s]", "t").lower())
    answer = CliRunner().invoke(cli, ["check", str(folder)])
    assert "Positions are latitude and longitude, not metres" in answer.output
    assert "import RUN --pose FILE" in answer.output
