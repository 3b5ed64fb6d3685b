"""Stretches without images, by the way of the robot on them."""

from dataclasses import replace

import numpy as np
import pytest

import terrain
from odometry.checks.findings.finding import Level
from terrain.checks.image_gaps import image_gaps


def of_rows(run, kept):
    images = run.images
    columns = {name: of[kept] for name, of in images.columns.items()}
    return replace(run, images=replace(images, columns=columns, lines=images.lines[kept]))


def without(run, begin_s, end_s):
    stamps_s = run.images.stamps_s - run.odometry.stamps_s[0]
    return of_rows(run, (stamps_s < begin_s) | (stamps_s > end_s))


def test_a_drive_with_all_its_images_has_no_gap(drive):
    assert list(image_gaps(drive)) == []


@pytest.mark.parametrize(("begin_s", "end_s"), [(12.0, 32.0), (-1.0, 10.0), (40.0, 1000.0)])
def test_a_gap_is_a_note_with_its_time_and_way(drive, begin_s, end_s):
    report = terrain.check_run(without(drive, begin_s, end_s))
    (finding,) = [one for one in report.findings if one.name == "images_gap"]
    assert finding.level is Level.NOTE
    ((first, last),) = finding.spans_s
    stamps_s = drive.odometry.stamps_s
    at_s = stamps_s[0] + np.array([first, last])
    way_m = np.ptp(np.interp(at_s, stamps_s, drive.wheel_travel_m))
    assert first == pytest.approx(max(begin_s, 0.0), abs=0.6)
    assert f"drives {way_m:.3g} m" in finding.seen


def test_several_gaps_are_one_note(drive):
    run = drive
    for begin_s in (3, 14, 25, 36):
        run = without(run, begin_s, begin_s + 7)
    (finding,) = image_gaps(run)
    assert len(finding.spans_s) == 4
    assert "and 1 more gap" in finding.seen


def test_a_robot_that_stands_leaves_no_gap(drive):
    stamps_s = drive.odometry.stamps_s - drive.odometry.stamps_s[0]
    still = (stamps_s > 12) & (stamps_s < 32)
    columns = {name: np.where(still, 0.0, drive.odometry[name]) for name in ("v_left", "v_right")}
    odometer = replace(drive.odometry, columns={**drive.odometry.columns, **columns})
    run = replace(without(drive, 12.5, 31.5), odometry=odometer)
    assert list(image_gaps(run)) == []


def test_images_each_few_metres_have_no_gaps(drive):
    assert list(image_gaps(of_rows(drive, np.arange(0, len(drive.images), 12)))) == []


def test_images_that_come_at_once_are_named_and_no_mount_is_judged_by_them(drive):
    """Three at a time, ten milliseconds apart."""
    stamps_s = drive.images.stamps_s
    rows = np.arange(len(stamps_s))
    last = np.minimum(rows // 3 * 3 + 2, len(rows) - 1)
    columns = {**drive.images.columns, "t": stamps_s[last] + 0.01 * (rows % 3)}
    report = terrain.check_run(replace(drive, images=replace(drive.images, columns=columns)))
    (finding,) = report.at(Level.WARNING)
    assert finding.name == "image_bursts"
    assert "rows of images.csv come in" in finding.seen
    assert finding.cause.startswith("Either stamps are those of arrival")
    assert "the motion of the treads: see the warnings" in " ".join(report.skipped)
