"""Position files of RTKLIB: systems of time, kinds of solutions, what is refused."""

from datetime import UTC, datetime

import numpy as np
import pytest

from odometry.errors import TrajectoryError
from odometry.fixes.fixes import read_fixes
from odometry.fixes.rtklib import gps_ahead_s
from tests.odometry.fixes.made_fixes import HEIGHTS_M, LATITUDES, LONGITUDES, STAMPS_S, assert_usual

ABOVE = "% program   : RTKLIB ver.2.4.3\n% (Q=1:fix,2:float,3:sbas,4:dgps,5:single,6:ppp)\n"
COLUMNS = ("latitude(deg)", "longitude(deg)", "height(m)", "Q", "ns", "sdn(m)", "sde(m)")
DATE = "%Y/%m/%d %H:%M:%S.%f"


def date(stamp_s):
    return datetime.fromtimestamp(stamp_s, UTC).strftime(DATE)[:-3]


def week(stamp_s):
    since = stamp_s - datetime(1980, 1, 6, tzinfo=UTC).timestamp()
    return f"{int(since // 604800)} {since % 604800:.3f}"


def solution(folder, system="GPST", form=date, *, ahead_s=18.0, kinds=None, between="  "):
    kinds = kinds or [1] * len(STAMPS_S)
    rows = zip(STAMPS_S + ahead_s, LATITUDES, LONGITUDES, HEIGHTS_M, kinds, strict=True)
    lines = [
        between.join(
            [form(t), f"{lat:.9f}", f"{lon:.9f}", f"{h:.4f}", str(q), "12", "0.01", "0.02"]
        )
        for t, lat, lon, h, q in rows
    ]
    file = folder / "rover.pos"
    header = between.join([f"%  {system}", *COLUMNS])
    file.write_text("\n".join([f"{ABOVE}{header}", *lines]) + "\n")
    return file


@pytest.mark.parametrize("form", [date, week])
@pytest.mark.parametrize(("system", "ahead_s"), [("GPST", 18.0), ("UTC", 0.0), ("JST", 32400.0)])
@pytest.mark.parametrize("between", ["  ", ","])
def test_every_time_is_seconds_of_utc(tmp_path, form, system, ahead_s, between):
    found = read_fixes(solution(tmp_path, system, form, ahead_s=ahead_s, between=between))
    assert_usual(found)
    np.testing.assert_allclose(found.places[:, 2], HEIGHTS_M)
    assert not found.losses
    assert found.notes[0].startswith(f"stamps: '{system}")


@pytest.mark.parametrize(
    ("gps", "ahead_s"),
    [((2026, 11, 30, 0, 0, 18), 18), ((2017, 1, 1, 0, 0, 18), 18), ((2017, 1, 1, 0, 0, 16), 17)],
)
def test_leap_seconds_begin_at_their_midnight(gps, ahead_s):
    assert gps_ahead_s(datetime(*gps, tzinfo=UTC).timestamp()) == ahead_s


@pytest.mark.parametrize(
    ("kinds", "kept", "said"),
    [
        ([1] * 25 + [2] * 10 + [5] * 5, 25, "15 of 40 rows of a lesser kind than 'fix'"),
        ([1] * 10 + [2] * 25 + [5] * 5, 35, "5 of 40 rows of a lesser kind than 'float'"),
        ([5] * 40, 40, ""),
        ([1] * 35 + [0] * 5, 35, "5 of 40 rows without a fix ('Q' says so)"),
    ],
)
def test_lesser_kinds_than_the_usual_one_are_left_out(tmp_path, kinds, kept, said):
    """A change of kind is a jump, and lesser ones have errors that last."""
    found = read_fixes(solution(tmp_path, kinds=kinds))
    assert len(found.places) == kept
    assert said in " ".join(found.losses)
    assert bool(found.losses) == bool(said)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("latitude(deg)", "x-ecef(m)", r"its columns are x-ecef\(m\).*out-solformat = llh"),
        (
            "2023/11/14 22:13:38.000",
            "yesterday noon",
            r"row 4: 'yesterday noon .*two words \(GPST\)",
        ),
        ("  0.02\n", "\n", "row 4: .* 7 numbers"),
        ("48.100000000", "north", "row 4, column 'latitude"),
    ],
)
def test_what_is_not_as_the_header_says_is_refused(tmp_path, old, new, said):
    file = solution(tmp_path)
    assert old in file.read_text()
    file.write_text(file.read_text().replace(old, new, 1))
    with pytest.raises(TrajectoryError, match=said):
        read_fixes(file)


def test_a_file_without_rows_is_refused(tmp_path):
    file = tmp_path / "rover.pos"
    file.write_text(f"{ABOVE}%  GPST  {'  '.join(COLUMNS)}\n")
    with pytest.raises(TrajectoryError, match="no rows below the header"):
        read_fixes(file)
