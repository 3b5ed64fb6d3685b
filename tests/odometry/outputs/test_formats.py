import tomllib

import pytest

from odometry.errors import ParameterError
from odometry.outputs.formats import check_format, check_text_format, format_line, stated_format


def test_the_line_is_a_comment_that_gives_back_kind_and_version():
    line = format_line("parameter set", 3)
    assert tomllib.loads(line) == {}
    assert stated_format(line + "[vehicle]\n") == ("parameter set", 3)
    assert stated_format("[vehicle]\n" + line) is None


@pytest.mark.parametrize("stated", [None, 0, True, "1", 1.0])
def test_no_version_is_an_error(stated):
    with pytest.raises(ParameterError, match=r"file: format = .* expected a number from 1 to 2"):
        check_format("file", stated, 2, ParameterError)


def test_a_newer_version_is_named_and_an_older_one_read():
    check_text_format("file", "x = 3\n", 1, ParameterError)
    check_text_format("file", format_line("mode set", 1), 2, ParameterError)
    with pytest.raises(ParameterError, match="file: made by a newer version of terrain-odometry"):
        check_text_format("file", format_line("mode set", 3), 2, ParameterError)
