"""What values say of rows that come together."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.tables.row_values import are_copies
from tests.odometry.arrivals import stamped
from tests.odometry.checks.drives import winding


@pytest.mark.parametrize("copied", [True, False])
def test_rows_that_were_dropped_are_known_once_the_others_have_other_stamps(copied):
    rows = winding(400).odometry
    each = np.sort(np.append(np.arange(len(rows)), np.arange(100, 110)))
    again = each if copied else np.arange(len(each)) % len(rows)
    table = stamped(rows, rows.stamps_s[each], again)
    moved = replace(table, columns={**table.columns, "t": table.stamps_s + 0.004})
    assert are_copies(table) == are_copies(moved) == copied
