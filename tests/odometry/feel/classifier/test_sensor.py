"""A spectrum that cannot come from the IMU of a model is unknown, and it is said why."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import RunFolderError
from odometry.feel.classifier.design import Design
from odometry.feel.classifier.sensor import (
    LEAST_RUNS,
    LEAST_WINDOWS,
    SensorShape,
    ShapeSoFar,
    shapes,
)
from odometry.feel.labels.files import sentences
from odometry.feel.labels.follow import follow_feel
from odometry.feel.labels.live_run import follow_feel_live
from odometry.feel.model_file import FEEL, FeelFileError, read_feel_model, write_feel_model
from odometry.feel.recorded.windows import BY_WINDOW, feel_windows
from odometry.io.array_file import read_array_file, write_array_file
from odometry.recording.run import UNKNOWN
from tests.odometry.feel.feel_drives import drive, drives, table, with_imu

NAMES = ("tiles", "gravel", "snow")


def averaged(samples):
    """A moving average over so many samples, of every axis."""

    def change(columns):
        for name in columns:
            if name != "t":
                padded = np.concatenate([np.full(samples - 1, columns[name][0]), columns[name]])
                columns[name] = np.convolve(padded, np.full(samples, 1 / samples), "valid")
        return columns

    return change


def every_other(columns):
    """Sampled half as often, and interpolated."""
    for name in columns:
        if name != "t":
            columns[name] = np.interp(columns["t"], columns["t"][::2], columns[name][::2])
    return columns


def one_after_another(*runs):
    """One run that drives all of them."""
    found = runs[0]
    for run in runs[1:]:
        rows = []
        for one, other in ((found.odometry, run.odometry), (found.imu, run.imu)):
            after_s = one["t"][-1] + one["t"][1] - one["t"][0]
            columns = other.columns | {"t": other["t"] + after_s}
            rows.append(table({n: np.concatenate([one[n], columns[n]]) for n in columns}))
        found = replace(found, odometry=rows[0], imu=rows[1])
    return found


def windows_before(windows, count):
    """The first windows."""
    rows = {name: getattr(windows, name)[:count] for name in BY_WINDOW}
    return replace(windows, **rows)


def blind(model):
    """The same model without the shape of its spectra."""
    return replace(model, sensor=None)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("change", [averaged(3), averaged(5), every_other])
def test_a_filter_or_another_rate_is_unknown_and_said(model, name, change):
    felt = follow_feel(with_imu(drive(name, 950), change), model)
    assert felt.foreign.all()
    assert set(felt.answers) == set(felt.lasting_answers) == {UNKNOWN}
    assert felt.answer_of_run[0] == UNKNOWN
    (why,) = [line for line in sentences(felt) if "spectrum" in line]
    assert "another filter, sampling rate or mounting of the IMU" in why
    assert " Hz)" in why


def scaled(factor, kind):
    """Another scale of the gyroscope, or of what the accelerations differ from their mean."""

    def change(columns):
        for name, of in columns.items():
            if name.startswith(kind):
                middle = of.mean() if kind == "accel" else 0.0
                columns[name] = middle + factor * (of - middle)
        return columns

    return change


@pytest.mark.parametrize("name", ["gravel", "snow"])  # twice of tiles, the least, is within
@pytest.mark.parametrize(
    ("change", "times"),
    [(scaled(2.0, "gyro"), 2.0), (scaled(0.5, "gyro"), 0.5), (scaled(2.0, "accel"), 0.5)],
)
def test_another_scale_of_one_sensor_is_unknown_and_said(model, name, change, times):
    felt = follow_feel(with_imu(drive(name, 950), change), model)
    assert felt.foreign.all()
    assert felt.answer_of_run[0] == UNKNOWN
    (why,) = [line for line in sentences(felt) if "another scale" in line]
    said = float(why.partition("turns the robot ")[2].partition(" ")[0])
    assert said == pytest.approx(times, rel=0.4)
    same = model.sensor.of_windows(feel_windows(drive(name, 950)), model.design.axes)
    other = model.sensor.of_windows(felt.windows, model.design.axes)
    np.testing.assert_allclose(other[:, :-1], same[:, :-1], atol=1e-4)
    np.testing.assert_allclose(other[:, -1] - same[:, -1], np.log(times**2), atol=1e-4)


def test_fresh_runs_of_the_same_imu_are_not_foreign(model):
    felt = [follow_feel(drive(name, 960 + i), model) for i, name in enumerate(NAMES * 4)]
    assert np.mean([one.foreign.any() for one in felt]) <= 1 / 6
    known = [one for one in felt if not one.foreign.any()]
    assert not any("spectrum" in line for one in known for line in sentences(one))


def test_live_says_so_once_enough_is_known(model):
    run = with_imu(drive("gravel", 950), averaged(5))
    felt = follow_feel_live(run, model)
    moving = np.cumsum(felt.windows.felt)
    assert not felt.foreign[moving < LEAST_WINDOWS].any()
    assert felt.foreign[moving >= LEAST_WINDOWS].all()
    assert felt.answer_of_run[0] == UNKNOWN
    same = follow_feel_live(drive("gravel", 960), model)
    assert not same.foreign.any()


@pytest.mark.parametrize("names", [("gravel", "grates"), ("grates", "gravel")])
def test_a_terrain_without_training_in_a_part_of_a_run_is_no_other_imu(model, names):
    """Of all windows together the shape is unlike; of those on gravel it is not."""
    parts = [drive(name, 950) for name in names]
    run = one_after_another(*parts)
    so_far = model.shape_so_far.plus(feel_windows(run))
    assert model.sensor.excess(so_far.total / so_far.count) > 1
    assert not follow_feel(run, model).foreign.any()
    alone = [follow_feel(part, model).foreign.all() for part in parts]
    assert alone == [name == "grates" for name in names]


def test_live_is_at_each_window_the_run_up_to_there(model):
    """Known terrain, one without training runs, and known again; and another filter."""
    changes = [drive("gravel", 950), drive("grates", 951), drive("tiles", 952, seconds=60.0)]
    filtered = with_imu(drive("gravel", 950), averaged(5))
    found = []
    for run in (one_after_another(*changes), one_after_another(*changes[1:]), filtered):
        felt = follow_feel_live(run, model)
        counts = range(1, len(felt.windows) + 1)
        upto = [model.foreign(windows_before(felt.windows, count))[-1] for count in counts]
        np.testing.assert_array_equal(felt.foreign, upto)
        found.append((felt.foreign.any(), felt.foreign[-1], follow_feel(run, model).foreign[-1]))
    assert found == [(False, False, False), (True, False, False), (True, True, True)]


def test_one_part_that_is_like_leaves_another_imu_another_one(model):
    run = one_after_another(
        drive("gravel", 950, seconds=LEAST_WINDOWS + 1.0),
        with_imu(drive("tiles", 951, seconds=90.0), averaged(5)),
    )
    assert follow_feel(run, model).foreign.all()


def test_a_shape_is_that_of_all_axes_whatever_their_size(model):
    windows = feel_windows(drive("gravel", 970))
    axes, edges = model.design.axes, model.sensor.edges_hz
    one, other = (
        shapes(replace(windows, densities=windows.densities * factor), axes, edges)
        for factor in (1.0, 9.0)
    )
    np.testing.assert_allclose(one, other, atol=1e-4)  # the least power is added to both
    np.testing.assert_allclose(one[:, :-1].mean(axis=1), 0, atol=1e-12)


def test_the_limit_is_the_farthest_of_the_runs_from_the_others(model):
    windows = [feel_windows(run) for run in drives(NAMES)]
    found = SensorShape.of(windows, model.design)
    table = np.array(
        [shapes(w, model.design.axes, found.edges_hz)[w.felt].mean(0) for w in windows]
    )
    apart = []
    for row in range(len(table)):
        others = np.delete(table, row, axis=0)
        off = (table[row] - others.mean(0)) / others.std(0, ddof=1)
        apart.append((np.mean(off[:-1] ** 2), off[-1] ** 2))
    np.testing.assert_allclose(found.limits, np.max(apart, axis=0))
    np.testing.assert_allclose(found.excess(found.mean), 0)
    so_far = ShapeSoFar.none(found, model.design.axes)
    assert not so_far.is_foreign
    np.testing.assert_allclose(so_far.plus(windows[0]).total / windows[0].felt.sum(), table[0])


def test_samples_that_repeat_more_than_in_training_are_refused(model, tmp_path):
    def rounded(columns):
        return columns | {"gyro_x": np.round(columns["gyro_x"] / 0.2) * 0.2}

    run = with_imu(drive("gravel", 980), rounded)
    assert model.repeats == 0
    with pytest.raises(RunFolderError, match="rounded more coarsely"):
        follow_feel(run, model)
    write_feel_model(
        tmp_path / "a.feel", replace(model, repeats=feel_windows(run).repeats["gyro_x"])
    )
    assert len(follow_feel(run, read_feel_model(tmp_path / "a.feel")).windows)
    settings, arrays = read_array_file(tmp_path / "a.feel", FEEL)
    del settings["repeats"]
    write_array_file(tmp_path / "old.feel", FEEL, settings, arrays)
    assert len(follow_feel(run, read_feel_model(tmp_path / "old.feel")).windows)


def test_samples_of_an_axis_that_is_not_used_may_repeat():
    run = drive("gravel", 981)
    rows = np.arange(len(run.imu)) // 2 * 2
    windows = feel_windows(with_imu(run, lambda c: c | {"gyro_z": c["gyro_z"][rows]}))
    assert windows.most_repeats(["gyro_x", "accel_y"]) == 0
    assert windows.most_repeats(["gyro_x", "gyro_z"]) == pytest.approx(0.5, abs=0.02)


def test_few_runs_and_no_axis_know_no_shape(model):
    windows = [feel_windows(run) for run in drives(NAMES)]
    assert SensorShape.of(windows[: LEAST_RUNS - 1], model.design) is None
    no_axis = Design(2.0, (), ("yaw",), 50.0, (0,), shaped=False)
    assert SensorShape.of(windows, no_axis) is None
    assert not follow_feel(with_imu(drive("snow", 950), averaged(5)), blind(model)).foreign.any()


def test_a_file_keeps_it_and_older_ones_have_none(model, tmp_path):
    file = tmp_path / "a.feel"
    write_feel_model(file, model)
    read = read_feel_model(file).sensor
    np.testing.assert_array_equal(read.limits, model.sensor.limits)
    np.testing.assert_array_equal(read.mean, model.sensor.mean)
    settings, arrays = read_array_file(file, FEEL)
    old = {name: of for name, of in arrays.items() if not name.startswith("sensor_")}
    write_array_file(tmp_path / "old.feel", FEEL, settings, old)
    assert read_feel_model(tmp_path / "old.feel").sensor is None
    no_ratio = {"sensor_mean": read.mean[:-1], "sensor_deviation": read.deviation[:-1]}
    older = arrays | no_ratio | {"sensor_limit": read.limits[:1]}
    write_array_file(tmp_path / "older.feel", FEEL, settings, older)
    twice = with_imu(drive("gravel", 960), scaled(2.0, "gyro"))
    assert not follow_feel(twice, read_feel_model(tmp_path / "older.feel")).foreign.any()
    for bad in ({"sensor_limit": np.zeros(1)}, {"sensor_mean": np.zeros(3)}):
        write_array_file(tmp_path / "bad.feel", FEEL, settings, arrays | bad)
        with pytest.raises(FeelFileError, match="shapes of spectra"):
            read_feel_model(tmp_path / "bad.feel")
