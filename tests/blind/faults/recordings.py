"""A run folder as values: its tables by column, its settings as text, and how a copy is written.

What a fault does not change is copied byte for byte.
"""

import csv
import math
import shutil
import tomllib
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

TEXT = ("terrain", "file")


@dataclass(frozen=True, eq=False)
class Recording:
    """A run folder.

    Attributes
    ----------
    folder : Path
        Where it was read.
    settings : str
        Text of run.toml.
    tables : dict
        Columns by name, by file name without its ending; an empty cell is NaN.
    files : dict
        Other contents by file name: bytes to write instead, or None to leave it out.
    """

    folder: Path
    settings: str
    tables: dict
    files: dict = field(default_factory=dict)

    def __getitem__(self, name):
        return self.tables[name]

    def __contains__(self, name):
        return name in self.tables

    @property
    def robot(self):
        return tomllib.loads(self.settings)["robot"]

    def with_columns(self, name, **columns):
        """Columns of one table replaced or added."""
        return replace(self, tables=self.tables | {name: self.tables[name] | columns})

    def with_table(self, name, columns):
        """A whole table replaced, in the order of the columns given."""
        return replace(self, tables=self.tables | {name: columns})

    def with_rows(self, name, index):
        """The rows of a table that an index or mask names."""
        rows = {key: column[index] for key, column in self.tables[name].items()}
        return self.with_table(name, rows)

    def with_settings(self, settings):
        return replace(self, settings=settings)

    def with_file(self, name, content):
        return replace(self, files=self.files | {name: content})

    def without(self, name):
        """Without a table."""
        tables = {key: table for key, table in self.tables.items() if key != name}
        return replace(self, tables=tables, files=self.files | {f"{name}.csv": None})

    def restamped(self, new_stamps, names=None):
        """Stamps through a function, in every table or in those named."""
        result = self
        for name in self.tables if names is None else names:
            result = result.with_columns(name, t=new_stamps(result[name]["t"]))
        return result


def read_recording(folder):
    tables = {file.stem: read_table(file) for file in sorted(Path(folder).glob("*.csv"))}
    return Recording(Path(folder), (Path(folder) / "run.toml").read_text("utf-8"), tables)


def read_table(file):
    with file.open(newline="", encoding="utf-8") as stream:
        header, *rows = list(csv.reader(stream))
    columns = zip(*rows, strict=True) if rows else [()] * len(header)
    return {name: _values(name, cells) for name, cells in zip(header, columns, strict=True)}


def _values(name, cells):
    if name in TEXT:
        return np.array(cells, dtype=object)
    return np.array([float(cell) if cell else math.nan for cell in cells])


def write_recording(recording, folder):
    """Write a changed recording beside the one that it was read from; returns the folder."""
    folder, original = Path(folder), read_recording(recording.folder)
    shutil.copytree(recording.folder, folder)
    if recording.settings != original.settings:
        (folder / "run.toml").write_text(recording.settings, "utf-8")
    for name, columns in recording.tables.items():
        if not _same(columns, original.tables.get(name)):
            (folder / f"{name}.csv").write_bytes(table_text(columns).encode())
    for name, content in recording.files.items():
        (folder / name).unlink(missing_ok=True)
        if content is not None:
            (folder / name).write_bytes(content)
    return folder


def table_text(columns, separator=","):
    cells = [[_cell(value) for value in column.tolist()] for column in columns.values()]
    lines = [columns.keys(), *zip(*cells, strict=True)]
    return "".join(separator.join(line) + "\n" for line in lines)


def _cell(value):
    if isinstance(value, float):
        return "" if math.isnan(value) else repr(round(value, 9))
    return str(value)


def _same(one, other):
    return (
        other is not None
        and list(one) == list(other)
        and all(_equal(one[name], other[name]) for name in one)
    )


def _equal(one, other):
    if len(one) != len(other) or one.dtype != other.dtype:
        return False
    return all(
        a == b or (a != a and b != b)  # noqa: PLR0124
        for a, b in zip(one.tolist(), other.tolist(), strict=True)
    )
