"""NMEA logs, against the sentences that the manual of the u-blox M8 prints."""

from datetime import UTC, datetime
from functools import reduce
from operator import xor

import numpy as np
import pytest

from odometry.errors import TrajectoryError
from odometry.fixes import nmea
from odometry.fixes.fixes import read_fixes
from tests.odometry.fixes.made_fixes import LATITUDES, LONGITUDES, STAMPS_S, assert_usual

GGA = "$GPGGA,092725.00,4717.11399,N,00833.91590,E,1,08,1.01,499.6,M,48.0,M,,*5B"
RMC = "$GPRMC,083559.00,A,4717.11437,N,00833.91522,E,0.004,77.52,091202,,,A*57"
ZDA = "$GPZDA,082710.00,16,09,2002,00,00*64"


def sentence(*fields):
    text = ",".join(fields)
    return f"${text}*{reduce(xor, text.encode()):02X}"


def minutes(angle, digits, sides):
    degrees, rest = divmod(abs(angle), 1)
    return f"{int(degrees):0{digits}d}{60 * rest:011.8f}", sides[int(angle < 0)]


def gga(stamp_s, latitude, longitude, quality="4"):
    time = datetime.fromtimestamp(stamp_s, UTC).strftime("%H%M%S.%f")[:-4]
    places = *minutes(latitude, 2, "NS"), *minutes(longitude, 3, "EW")
    return sentence("GNGGA", time, *places, quality, "12", "0.6", "465.6", "M", "46.9", "M", "", "")


def rmc(stamp_s):
    moment = datetime.fromtimestamp(stamp_s, UTC)
    date = moment.strftime("%d%m%y")
    return sentence("GNRMC", moment.strftime("%H%M%S.00"), "A", *[""] * 6, date, "", "", "A")


def log(folder, *lines):
    file = folder / "receiver.nmea"
    file.write_text("\r\n".join(lines) + "\r\n")
    return file


@pytest.mark.parametrize(("dated", "day"), [(RMC, (2002, 12, 9)), (ZDA, (2002, 9, 16))])
def test_the_sentences_of_a_manual(tmp_path, dated, day):
    found = read_fixes(log(tmp_path, dated, GGA))
    np.testing.assert_allclose(
        found.places, [[47 + 17.11399 / 60, 8 + 33.91590 / 60, 499.6 + 48.0]], rtol=0, atol=1e-12
    )
    assert found.stamps_s == datetime(*day, 9, 27, 25, tzinfo=UTC).timestamp()


def test_a_drive_between_other_sentences(tmp_path):
    lines = []
    for stamp_s, latitude, longitude in zip(STAMPS_S, LATITUDES, LONGITUDES, strict=True):
        lines += [
            rmc(stamp_s),
            "$GNGSA,A,3*00",
            f"1700000000.1 {gga(stamp_s, latitude, longitude)}",
        ]
    found = read_fixes(log(tmp_path, *lines))
    assert_usual(found)
    np.testing.assert_allclose(found.places[:, 2], 512.5)


def test_south_west_and_midnight(tmp_path):
    midnight_s = datetime(2026, 11, 30, tzinfo=UTC).timestamp()
    stamps_s = midnight_s + np.arange(-3, 3)
    lines = [
        rmc(stamps_s[0]),
        *(gga(stamp_s, -33.5, -70.25 - 1e-6 * k) for k, stamp_s in enumerate(stamps_s)),
    ]
    found = read_fixes(log(tmp_path, *lines))
    np.testing.assert_allclose(found.stamps_s, stamps_s)
    np.testing.assert_allclose(found.places[:, 0], -33.5)
    assert (found.places[:, 1] < -70.2).all()


def test_dates_of_a_long_log_are_found_in_one_go(tmp_path, monkeypatch):
    """Row by row they took minutes of a log of an hour."""
    calls, dated = [], nmea._dated
    monkeypatch.setattr(nmea, "_dated", lambda *of: calls.append(1) or dated(*of))
    stamps_s = datetime(2026, 11, 30, tzinfo=UTC).timestamp() + 43_000 * np.arange(8)
    lines = [of(stamp_s) for stamp_s in stamps_s for of in (rmc, lambda s: gga(s, 48.0, s / 1e9))]
    np.testing.assert_allclose(read_fixes(log(tmp_path, *lines)).stamps_s, stamps_s)
    assert len(calls) == 1


@pytest.mark.parametrize(
    "early",
    [
        sentence("GNRMC", "000005.00", "V", *[""] * 6, "060180", "", "", "N"),
        sentence("GNZDA", "000005.00", "06", "01", "1980", "00", "00"),
    ],
)
def test_a_date_before_the_first_fix_is_none(tmp_path, early):
    lines = [rmc(STAMPS_S[0]), early, early]
    lines += [gga(*each) for each in zip(STAMPS_S, LATITUDES, LONGITUDES, strict=True)]
    assert_usual(read_fixes(log(tmp_path, *lines)))


def test_lesser_kinds_no_fix_and_damaged_sentences_are_left_out(tmp_path):
    kinds = ["4"] * 25 + ["5"] * 8 + ["1"] * 4 + ["0"] * 3
    drive = zip(STAMPS_S, LATITUDES, LONGITUDES, kinds, strict=True)
    lines = [rmc(STAMPS_S[0]), *(gga(*each) for each in drive)]
    lines[3] = lines[3].replace("4806", "4807")
    found = read_fixes(log(tmp_path, *lines))
    assert len(found.places) == 24
    assert "3 of 39 rows without a fix ('quality' says so)" in found.losses[0]
    assert "lesser kind than 'fix' ('float' in 8 and 'single' in 4)" in found.losses[1]


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ([GGA], "no sentence RMC or ZDA, which state the date"),
        ([RMC, GGA.replace("5B", "5C")], "no sentence GGA with a right checksum"),
        ([RMC, sentence("GPGGA", "9x2725.00", *[""] * 5, "1")], "row 2: .* cannot be read as GGA"),
        ([RMC, sentence("GPGGA", "092725.00", *[""] * 5)], "row 2: .* cannot be read as GGA"),
        ([RMC, sentence("GPGGA", "092725.00", "4717.1")], "row 2: .* cannot be read as GGA"),
    ],
)
def test_what_is_refused(tmp_path, lines, said):
    with pytest.raises(TrajectoryError, match=said):
        read_fixes(log(tmp_path, *lines))
