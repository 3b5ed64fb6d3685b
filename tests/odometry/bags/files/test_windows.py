"""Windows of a file: the whole of it, with overlaps, however it is cut."""

import io

from hypothesis import given
from hypothesis import strategies as st

from odometry.bags.files import damage as module
from odometry.bags.files.damage import windows


@given(
    st.binary(min_size=100, max_size=200),
    st.integers(0, 60),
    st.integers(2, 9),
    st.integers(10, 40),
)
def test_every_word_up_to_the_overlap_lies_whole_in_a_window(content, begin, overlap, size):
    before = module.SEARCHED
    module.SEARCHED = size
    try:
        found = list(windows(io.BytesIO(content), begin, overlap))
    finally:
        module.SEARCHED = before
    for place, window in found:
        assert content[place : place + len(window)] == window
    for place in range(begin, len(content) - overlap + 1):
        word = slice(place, place + overlap)
        assert any(
            first <= word.start and word.stop <= first + len(window) for first, window in found
        )
