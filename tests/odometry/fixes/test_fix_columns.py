"""Headers of programs that log positions by satellites."""

from pathlib import Path

import pytest

from odometry.errors import TrajectoryError
from odometry.fixes.fix_columns import Header, columns_of, header_of

ROSTOPIC = (
    "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.status.status,"
    "field.status.service,field.latitude,field.longitude,field.altitude,field.position_covariance0"
)
BAGPY = "Time,header.seq,header.stamp.secs,header.stamp.nsecs,status.status,latitude,longitude"
PLOTJUGGLER = "__time,/gps/fix/latitude,/gps/fix/longitude,/gps/fix/altitude"
PHONE = '"Time (s)","Latitude (°)","Longitude (°)","Height (m)","Horizontal Accuracy (m)"'
FLIGHT = "timestamp,time_utc_usec,lat,lon,alt,alt_ellipsoid,eph,fix_type,satellites_used"
ANDROID = "time,lat,lon,elevation,accuracy,bearing,speed,satellites,provider,hdop"
UBLOX = "iTOW_ms,unix_ms,fixType,lat,lon,height,hAcc"
ARDUPILOT = "TimeUS,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd"


@pytest.mark.parametrize(
    ("header", "latitude", "stamps", "states"),
    [
        (ROSTOPIC, "field.latitude", ["%time", "field.header.stamp"], ["field.status.status"]),
        (
            BAGPY,
            "latitude",
            [("header.stamp.secs", "header.stamp.nsecs"), "Time", "header.stamp.secs"],
            ["status.status"],
        ),
        (PLOTJUGGLER, "/gps/fix/latitude", ["__time"], []),
        (PHONE, "Latitude (°)", ["Time (s)"], []),
        (FLIGHT, "lat", ["timestamp", "time_utc_usec"], ["fix_type"]),
        (ANDROID, "lat", ["time"], []),
        (UBLOX, "lat", ["iTOW_ms", "unix_ms"], ["fixType"]),
        (ARDUPILOT, "Lat", ["TimeUS"], ["Status"]),
    ],
)
def test_columns_are_found_by_their_names(tmp_path, header, latitude, stamps, states):
    file = tmp_path / "gnss.csv"
    file.write_text(header + "\n")
    assert header_of(file) == Header()
    found = columns_of(header.replace('"', "").split(","), file)
    assert found.latitude.column == latitude
    names = [
        tuple(one.column for one in each) if isinstance(each, tuple) else each.column
        for each in found.stamps
    ]
    assert names == stamps
    assert [each.column for each in found.states] == states


def test_units_that_names_state():
    header = ["time_ms", "lat_rad", "lon [rad]", "alt_mm"]
    found = columns_of(header, Path("gnss.csv"))
    assert (found.latitude.says, found.longitude.says, found.altitude.says) == ("rad", "rad", "mm")
    assert found.stamps[0].says == "ms"


def test_lines_above_the_header_and_other_separators(tmp_path):
    file = tmp_path / "gnss.csv"
    file.write_text("# a logger\n# of a farm\ntime;lat;lon\n")
    assert header_of(file) == Header(2, ";")
    file.write_text("t,x,y,yaw\n")
    assert header_of(file) is None
    file.write_text("late,lateral,longest,lonely\n")
    assert header_of(file) is None


def test_two_receivers_are_refused():
    header = ["t", "/left/latitude", "/left/longitude", "/right/latitude", "/right/longitude"]
    with pytest.raises(TrajectoryError, match="2 columns may be the same angle"):
        columns_of(header, Path("gnss.csv"))


def test_a_file_without_stamps_is_refused():
    with pytest.raises(TrajectoryError, match="no column is named as a stamp"):
        columns_of(["lat", "lon"], Path("gnss.csv"))
