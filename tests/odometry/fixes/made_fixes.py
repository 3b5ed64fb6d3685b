"""A CSV file of satellite fixes as tests change it."""

import numpy as np

BEGIN_S = 1_700_000_000.0
ROWS = 40
STAMPS_S = BEGIN_S + np.arange(ROWS) / 5
LATITUDES = 48.1 + np.arange(ROWS) * 2.0371e-6
LONGITUDES = 11.5 + np.sin(np.arange(ROWS) / 7) * 3e-5
HEIGHTS_M = np.full(ROWS, 512.5)


def written(folder, columns, separator=","):
    """A CSV file of columns; numbers with nine decimals, texts as they are."""
    cells = [
        [each if isinstance(each, str) else f"{each:.9f}" for each in column]
        for column in columns.values()
    ]
    file = folder / "gnss.csv"
    lines = [separator.join(columns), *(separator.join(row) for row in zip(*cells, strict=True))]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def usual(**changed):
    columns = {"time": STAMPS_S, "latitude": LATITUDES, "longitude": LONGITUDES}
    return columns | {"altitude": HEIGHTS_M} | changed


def assert_usual(found):
    np.testing.assert_allclose(found.stamps_s, STAMPS_S, atol=1e-6)
    np.testing.assert_allclose(found.places[:, 0], LATITUDES, atol=2e-9)
    np.testing.assert_allclose(found.places[:, 1], LONGITUDES, atol=2e-9)
