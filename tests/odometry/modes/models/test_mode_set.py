"""A set of modes as TOML: what is written is what is read, and what cannot be read is refused."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from odometry.errors import ParameterError
from odometry.modes.models.mode_set import ModeSet
from odometry.modes.models.mode_set_file import (
    HEAD,
    KINDS,
    MODE,
    OPTIONAL,
    OPTIONAL_MODE,
    read_mode_set,
    write_mode_set,
)
from tests.odometry.modes.mode_examples import traction_set, velocity_set

finite = st.floats(-1e6, 1e6)
positive = st.floats(1e-12, 1e6)
name_lists = st.lists(st.text(min_size=1), min_size=1, max_size=4, unique=True)


@st.composite
def mode_sets(draw):
    """Sets of either kind, of any names, with every number that a file holds."""
    names, kind = tuple(draw(name_lists)), draw(st.sampled_from(sorted(KINDS)))

    def drawn(one, *many):
        shape = (*many, *one.shape)
        return draw(arrays(np.float64, shape, elements=positive if one.sign else finite))

    given_too = [one for one in OPTIONAL[kind] if draw(st.booleans())]
    values = {one.name: drawn(one) for one in (*HEAD[kind], *given_too)}
    values = {name: of if of.shape else float(of) for name, of in values.items()}
    of_each = (*MODE[kind], *(one for one in OPTIONAL_MODE[kind] if draw(st.booleans())))
    values |= {one.name: drawn(one, len(names)) for one in of_each}
    if kind == "velocity":
        values["A"] -= 3e6 * np.eye(2)  # that decays
    dwell_s = draw(arrays(np.float64, len(names), elements=positive))
    return ModeSet(KINDS[kind](names=names, **values), dwell_s, draw(st.text()))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(mode_sets())
def test_what_is_written_is_read(tmp_path, mode_set):
    file = tmp_path / "set.toml"
    write_mode_set(file, mode_set)
    again = read_mode_set(file)
    assert (again.names, again.source) == (mode_set.names, mode_set.source)
    np.testing.assert_array_equal(again.dwell_s, mode_set.dwell_s)
    written, read = vars(mode_set.modes), vars(again.modes)
    assert type(again.modes) is type(mode_set.modes)
    assert written.keys() == read.keys()
    for name, value in written.items():
        np.testing.assert_array_equal(read[name], value)


@pytest.fixture
def edited(tmp_path):
    """Read a set after one text of its file was replaced."""

    def read(mode_set, old, new):
        file = tmp_path / "set.toml"
        write_mode_set(file, mode_set)
        content = file.read_text()
        assert old in content
        file.write_text(content.replace(old, new, 1))
        return read_mode_set(file)

    return read


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('kind = "velocity"', 'kind = "flying"', r"expected \[modes\] with kind = one of velocity"),
        ("[modes]", "[others]", r"expected \[modes\] with kind"),
        ('source = "by hand"', "sauce = 1", r"\[modes\]: unknown key 'sauce'; known: .*source"),
        ("dwell_s", "dwell", r"\[mode\.ice\]: unknown key 'dwell'"),
        ("dwell_s = 20.0", "", r"\[mode\.ice\]: dwell_s is missing"),
        ("dwell_s = 20.0", "dwell_s = 0", r"\[mode\.ice\]: dwell_s = 0, expected .* above 0"),
        ("dwell_s = 20.0", "dwell_s = nan", r"\[mode\.ice\]: dwell_s = nan, expected finite"),
        ("dwell_s = 20.0", 'dwell_s = "long"', r"\[mode\.ice\]: dwell_s = 'long'"),
        ("errors_last_s = 0.0", "errors_last_s = [1, 2]", r"\[modes\]: errors_last_s = \[1, 2\]"),
        ("-500.0", "30.0", r"set\.toml: \[mode\.ice\] A: grows at 30 per second"),
        ("-500.0", "-1e300", r"\[mode\.ice\]: A = .*expected finite numbers, shape \(2, 2\)"),
        ("dwell_s = 20.0", "dwell_s = 1e-300", r"\[mode\.ice\]: dwell_s = 1e-300, expected"),
        ("-500.0", "inf", r"\[mode\.ice\]: A = .*expected finite numbers, shape \(2, 2\)"),
        ("kind =", "kind", "cannot be read as TOML"),
        ("mode.ice", "mode.unknown", r"set\.toml: a mode of the name 'unknown', expected none of"),
        ("mode.ice", "mode.undetermined", r"a mode of the name 'undetermined'"),
        ("mode.ice", "mode.'none of these'", r"a mode of the name 'none of these'"),
    ],
)
def test_what_cannot_be_is_reported_with_its_place(edited, old, new, message):
    with pytest.raises(ParameterError, match=message):
        edited(velocity_set(), old, new)


def test_traction_modes_need_their_own_keys(edited):
    with pytest.raises(ParameterError, match=r"set\.toml: \[modes\]: track_width = -0\.5"):
        edited(traction_set(), "track_width = 0.5", "track_width = -0.5")
    with pytest.raises(ParameterError, match=r"\[modes\]: unknown key 'errors_last_s'"):
        edited(traction_set(), "track_width", "errors_last_s = 1.0\ntrack_width")


@pytest.mark.parametrize("content", ['[modes]\nkind = "traction"\n', "[modes]\nkind = []\n"])
def test_a_set_without_modes_is_reported(tmp_path, content):
    file = tmp_path / "set.toml"
    file.write_text(content)
    with pytest.raises(ParameterError, match=r"set\.toml: expected "):
        read_mode_set(file)


def test_modes_must_be_tables(tmp_path):
    file = tmp_path / "set.toml"
    file.write_text('mode = 3\n[modes]\nkind = "velocity"\n')
    with pytest.raises(ParameterError, match=r"expected a table \[mode\.NAME\]"):
        read_mode_set(file)
    file.write_text('[modes]\nkind = "velocity"\nerrors_last_s = 0\n[mode]\nice = 3\n')
    with pytest.raises(ParameterError, match=r"\[mode\.ice\] = 3, expected a table"):
        read_mode_set(file)


def test_no_file_and_no_text_are_reported(tmp_path):
    with pytest.raises(ParameterError, match=r"absent\.toml: cannot be read: No such file"):
        read_mode_set(tmp_path / "absent.toml")
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe")
    with pytest.raises(ParameterError, match=r"bytes\.toml: cannot be read as TOML"):
        read_mode_set(tmp_path / "bytes.toml")
