"""Files of arrays: whatever is written is read, and a damaged file is refused or the same."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays_of

from odometry.errors import OdometryError
from odometry.io.array_file import FileKind, read_array_file, write_array_file

KIND = FileKind("made up", 1, "made up file", OdometryError)
VALUES = (
    st.none()
    | st.booleans()
    | st.integers(-(2**63), 2**63 - 1)
    | st.text()
    | st.floats(allow_nan=False)
)
SETTINGS = st.recursive(
    VALUES.filter(lambda value: not isinstance(value, float) or np.isfinite(value)),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=8,
)
ARRAYS = arrays_of.arrays(
    st.sampled_from([np.float64, np.float32, np.int64, np.int8]),
    arrays_of.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=4),
    elements={"allow_nan": False, "allow_infinity": False},
)


@given(st.dictionaries(st.text(), SETTINGS, max_size=3), st.lists(ARRAYS, max_size=3))
def test_what_is_written_reads_back(tmp_path_factory, given_settings, arrays):
    file = tmp_path_factory.mktemp("kept") / "a.model"
    write_array_file(file, KIND, given_settings, dict(zip("abc", arrays, strict=False)))
    read_settings, read_arrays = read_array_file(file, KIND)
    assert read_settings == given_settings
    assert list(read_arrays) == list("abc"[: len(arrays)])
    for one, other in zip(arrays, read_arrays.values(), strict=True):
        assert one.dtype == other.dtype
        np.testing.assert_array_equal(one, other)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    file = tmp_path_factory.mktemp("whole") / "a.model"
    write_array_file(file, KIND, {"k": 5}, {"a": np.arange(6.0), "b": np.zeros((2, 0), np.int8)})
    return file.read_bytes()


@settings(max_examples=300)
@given(st.floats(0.0, 1.0, exclude_max=True), st.integers(1, 255))
def test_a_byte_that_is_changed_changes_no_answer(whole, tmp_path_factory, place, by):
    """Refused in the project's own words, or one of the bytes that say nothing."""
    damaged = bytearray(whole)
    damaged[int(place * len(whole))] ^= by
    file = tmp_path_factory.mktemp("damaged") / "a.model"
    file.write_bytes(damaged)
    try:
        read_settings, arrays = read_array_file(file, KIND)
    except OdometryError:
        return
    assert read_settings == {"k": 5}
    np.testing.assert_array_equal(arrays["a"], np.arange(6.0))
    assert arrays["b"].shape == (2, 0)
