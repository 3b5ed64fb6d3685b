import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from odometry.errors import RunFolderError
from odometry.io import csv_columns
from odometry.io.csv_table import read_csv_table, write_csv_table


@pytest.fixture
def read(tmp_path):
    """Read literal text as a table that must have t and x; t must be complete."""

    def read_text(content, required=("t", "x"), complete=("t",)):
        file = tmp_path / "table.csv"
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
        return read_csv_table(file, required, complete)

    return read_text


def assert_refused(read, content, *words, **options):
    with pytest.raises(RunFolderError) as error:
        read(content, **options)
    for word in ("table.csv", *words):
        assert word in str(error.value)


def test_columns_are_found_by_name_in_any_order(read):
    table = read("b,x,t\n5,3,1\n6,4,2\n")
    assert table["t"].tolist() == [1, 2]
    assert table["x"].tolist() == [3, 4]


def test_unknown_columns_are_kept(read):
    table = read("t,x,speed limit,note\n1,2,3,dry\n2,3,4,wet\n")
    assert table["speed limit"].tolist() == [3, 4]
    assert table["note"].tolist() == ["dry", "wet"]


def test_an_empty_cell_is_not_measured(read):
    np.testing.assert_equal(read("t,x\n1,\n2,5\n")["x"], [np.nan, 5])


def test_an_empty_cell_of_an_unknown_number_column_is_nan(read):
    np.testing.assert_equal(read("t,x,extra\n1,0,\n2,0,7\n")["extra"], [np.nan, 7])


def test_names_stay_names_even_where_they_look_like_numbers(read):
    table = read("t,x,file,terrain\n1,0,0001,7\n2,0,1e3,\n")
    assert table["file"].tolist() == ["0001", "1e3"]
    assert table["terrain"].tolist() == ["7", ""]


@pytest.mark.parametrize(
    "content",
    [
        b"\xef\xbb\xbft,x\n1,2\n",
        b"t,x\r\n1,2\r\n",
        b"t,x\n1,2",
        b" t , x \n 1 , 2 \n",
        b'"t","x"\n"1","2"\n',
        b"t,x\n1,2\n\n",
        b"t,x\n+1.0E0,.2e1\n",
    ],
)
def test_spellings_that_other_programs_write(read, content):
    table = read(content)
    assert (table["t"].tolist(), table["x"].tolist()) == ([1], [2])


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("t\n1\n", ["'x'"]),
        ("", ["header"]),
        ("\n\n", ["header"]),
        ("t,x\n1,2\n2,2\n1.5,2\n", ["row 4", "t", "1.5"]),
        ("t,x\n1,2\n,2\n", ["row 3", "t"]),
        ("t,x\nnan,2\n", ["row 2", "t"]),
        ("t,x\n1,2\ninf,2\n", ["row 3", "t"]),
        ("t,x\n1,2\n2,fast\n", ["row 3", "x", "fast"]),
        ("t,x\n1,inf\n", ["row 2", "x", "inf"]),
        ("t,x\n1,1e999\n", ["row 2", "x", "1e999"]),
        ("t,x\n1,0x10\n", ["row 2", "x", "0x10"]),
        ("t,x\n1,2\n2,3,4\n", ["row 3", "3", "2"]),
        ("t,x\n1,2\n2\n", ["row 3", "1", "2"]),
        ("t,x,x\n1,2,3\n", ["'x'"]),
        ("t;a\n1;2\n", ["'t'"]),
        (b"t,x\n1,\xff\n", ["utf-8"]),
        (b"t,x\n1,\x002\n", ["row 2"]),
        (b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR", []),
    ],
)
def test_what_is_wrong_is_named(read, content, words):
    assert_refused(read, content, *words, required=("t", "x"), complete=("t",))


def test_row_numbers_are_lines_of_the_file_even_after_blank_lines(read):
    assert_refused(read, "t,x\n1,2\n\n3,x\n", "row 4")


def test_a_row_that_repeats_the_stamp_before_it_is_dropped(read):
    table = read("t,x\n1,2\n1,3\n2,4\n2,5\n2,6\n3,7\n")
    assert (table["t"].tolist(), table["x"].tolist()) == ([1, 2, 3], [2, 4, 7])
    assert (table.lines.tolist(), table.repeated_lines.tolist()) == ([2, 4, 7], [3, 5, 6])


def test_rows_that_were_dropped_are_kept_beside(read):
    table = read("t,x\n1,2\n1,3\n2,4\n2,5\n2,6\n3,7\n")
    assert table.repeated["x"].tolist() == [3, 5, 6]
    whole = table.with_repeated()
    assert (whole["x"].tolist(), whole["t"].tolist()) == ([2, 3, 4, 5, 6, 7], [1, 1, 2, 2, 2, 3])
    assert whole.lines.tolist() == [2, 3, 4, 5, 6, 7]
    part = table.rows(slice(1, 3)).with_repeated()
    assert part["x"].tolist() == [4, 5, 6, 7]
    assert whole.with_repeated() is whole


def test_a_column_that_must_be_complete_has_no_empty_cell(read):
    assert_refused(read, "t,x\n1,\n", "row 2", "x", complete=("t", "x"))
    assert_refused(read, "t,x\n1,nan\n", "row 2", "x", complete=("t", "x"))


def test_a_table_without_rows_is_refused(read):
    assert_refused(read, "t,x\n", "row")


def test_missing_file(tmp_path):
    with pytest.raises(RunFolderError, match=r"gone\.csv"):
        read_csv_table(tmp_path / "gone.csv", ("t",))


decimal = st.integers(-(10**15), 10**15).map(lambda nano: nano / 1e9)
# What a cell may hold: any text but for control characters, which no name of a terrain has.
name = st.text(st.characters(codec="utf-8", exclude_categories=["C", "Z"]), min_size=1)


@settings(max_examples=50)
@given(
    st.lists(st.integers(0, 10**13), min_size=1, max_size=8, unique=True).map(sorted),
    st.data(),
)
def test_what_is_written_reads_back(tmp_path_factory, stamps_us, data):
    n = len(stamps_us)
    columns = {
        "t": np.array(stamps_us) / 1e6,
        "value": np.array(data.draw(st.lists(decimal | st.just(np.nan), min_size=n, max_size=n))),
        "terrain": np.array(data.draw(st.lists(name | st.just(""), min_size=n, max_size=n))),
    }
    file = tmp_path_factory.getbasetemp() / "round_trip.csv"
    write_csv_table(file, columns)
    table = read_csv_table(file, ("t", "value", "terrain"), ("t",))
    np.testing.assert_array_equal(table["t"], columns["t"])
    if not np.isnan(columns["value"]).all():
        np.testing.assert_allclose(table["value"], columns["value"], rtol=1e-15, atol=5e-10)
    assert table["terrain"].tolist() == [str(cell) for cell in columns["terrain"]]


@pytest.mark.parametrize("first", ["=", "+", "-", "@", "'=", "''@"])
def test_a_name_that_a_spreadsheet_would_compute_is_written_as_text(tmp_path, first):
    text = first + "HYPERLINK(1)"
    file = tmp_path / "a.csv"
    write_csv_table(file, {"t": np.array([-1.0]), text: np.array([text])}, decimals=0)
    assert file.read_text() == f"t,'{text}\n-1,'{text}\n"
    assert read_csv_table(file, ("t",))[text].tolist() == [text]


@given(st.text("=+-@\uff1d\uff0b\uff0d\uff20\t\n'1a", min_size=1))
def test_texts_are_read_as_written_and_no_cell_is_a_formula(text):
    cell = csv_columns.quoted_text(text)
    assert csv_columns.unquoted_text(cell) == text
    if cell.startswith(csv_columns.FORMULA):
        assert float(cell) == float(text)


def test_the_same_table_gives_the_same_bytes(tmp_path):
    columns = {"t": np.arange(3.0), "x": np.array([0.1, np.nan, -0.0])}
    for file in ("one.csv", "two.csv"):
        write_csv_table(tmp_path / file, columns)
    assert (tmp_path / "one.csv").read_bytes() == (tmp_path / "two.csv").read_bytes()


def test_not_measured_is_an_empty_cell(tmp_path):
    write_csv_table(tmp_path / "a.csv", {"t": np.array([0.5]), "x": np.array([np.nan])})
    assert (tmp_path / "a.csv").read_text().splitlines()[1].endswith(",")


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("t,x\n1,2\n2,1e200\n", ["row 3", "'x'", "1e200", "at most 1e+11"]),
        ("t,v_left,x\n1,1e300,1\n", ["row 2", "'v_left'", "1e300", "at most 1e+06"]),
        ("t,x\n1e300,1\n", ["row 2", "'t'", "1e300", "at most 1e+19"]),
        ("t,x,file\n1,1," + "a" * 1001 + "\n", ["row 2", "'file'", "1001 characters"]),
        ("t,x,mine\n1,1," + "a" * 1001 + "\n", ["row 2", "'mine'", "1001 characters"]),
        ("t,x,file\n1,1,a\0b\n", ["row 2", "NUL"]),
        ('t,x\n1,"2\n', ["row 2", "CSV"]),
    ],
)
def test_what_no_robot_has_is_named(read, content, words):
    assert_refused(read, content, *words)


def test_stamps_in_nanoseconds_and_places_in_millimetres_are_read(read):
    table = read("t,x\n1763765720123456789,5400000000\n")
    assert (table["t"][0], table["x"][0]) == (1763765720123456789.0, 5.4e9)


@pytest.mark.parametrize("rows", [1, 2, 3, 7])
def test_blocks_make_one_table(read, monkeypatch, rows):
    """Numbers, names, an empty cell, a column that turns out to hold names in its last row."""
    content = "t,x,terrain,late,mine\n1,,a,1,2\n\n2,5,bb,2,\n2,6,c,3,4\n3,7,,x,5\n"
    whole = read(content)
    monkeypatch.setattr(csv_columns, "BLOCK_ROWS", rows)
    table = read(content)
    assert (table.lines.tolist(), table.repeated_lines.tolist()) == ([2, 4, 6], [5])
    assert table["late"].tolist() == ["1", "2", "x"]
    assert table["terrain"].tolist() == ["a", "bb", ""]
    for name in whole.columns:
        np.testing.assert_array_equal(table[name], whole[name], strict=True)
    assert_refused(read, "t,x\n1,2\n2,3\n3,4\n4,y\n", "row 5", "y")
    assert_refused(read, "t,x\n1,2\n2,3\n3,4\n3,4,5\n", "row 5", "3 cells")
