import tomllib

import pytest

from odometry.errors import ParameterError
from odometry.io.formats import check_first_line, check_format, format_line, stated_format


def test_the_line_is_a_comment_that_gives_back_kind_and_version():
    line = format_line("parameter set", 3)
    assert tomllib.loads(line) == {}
    assert stated_format(line + "[vehicle]\n") == ("parameter set", 3)
    assert stated_format("[vehicle]\n" + line) is None


@pytest.mark.parametrize("stated", [None, 0, True, "1", 1.0])
def test_no_version_is_an_error(stated):
    with pytest.raises(ParameterError, match=r"file: format = .* expected a number from 1 to 2"):
        check_format("file", stated, 2, ParameterError)


def test_a_newer_version_is_named_and_an_older_one_read(tmp_path):
    file = tmp_path / "set.toml"
    for text in ("x = 3\n", "", "\xff", format_line("mode set", 1)):
        file.write_text(text, encoding="latin-1")
        check_first_line(file, 2, ParameterError)
    file.write_text(format_line("mode set", 3))
    with pytest.raises(ParameterError, match=r"set\.toml: made by a newer version of terrain-odo"):
        check_first_line(file, 2, ParameterError)
