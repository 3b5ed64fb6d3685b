"""The files behind an input, and their SHA-256."""

import csv
import hashlib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from odometry.io.csv_columns import unquoted_text
from odometry.io.run_folder import FILES

RUN_FILES = ("run.toml", *(f"{name}.csv" for name in FILES))
RESULT_FILES = (
    "result.json",
    "learned.toml",
    *(f"{name}.csv" for name in ("odometer", "estimate", "terrain", "reference")),
)
PHOTO_SUFFIXES = (".jpg", ".jpeg", ".png")


@dataclass(frozen=True)
class Input:
    """A file, a run folder, a folder of results or of photographs, as the user named it.

    Attributes
    ----------
    role : str
        The option or argument that names it.
    path : Path
    files : tuple of Path
        What is read of it; those that are missing, or no files, are left out.
    images : tuple of Path
        Images of a run folder.
    """

    role: str
    path: Path
    files: tuple[Path, ...]
    images: tuple[Path, ...] = ()

    @classmethod
    def of(cls, role: str, path: Path) -> "Input":
        """Find the files of an input that may be missing or malformed."""
        if not path.is_dir():
            return cls(role, path, tuple(_files([path])))
        if (path / "run.toml").exists():
            images = tuple(_files(path / name for name in _image_names(path / "images.csv")))
            return cls(role, path, tuple(_files(path / name for name in RUN_FILES)), images)
        if (path / "result.json").exists():
            return cls(role, path, tuple(_files(path / name for name in RESULT_FILES)))
        photos = sorted(f for f in path.glob("*/*") if f.suffix.lower() in PHOTO_SUFFIXES)
        manifests = (path / "manifest.csv", path.parent / "manifest.csv")
        return cls(role, path, tuple(_files([*photos, *manifests])))

    def sha256(self, *, with_images: bool) -> str:
        """Of the one file; of a folder, of the names and sums of its files. Empty if unreadable."""
        try:
            if self.files == (self.path,):
                return file_sha256(self.path)
            files = self.files + (self.images if with_images else ())
            lines = [f"{self._name(file)}\0{file_sha256(file)}\n" for file in files]
        except OSError:
            return ""
        return hashlib.sha256("".join(lines).encode(errors="surrogateescape")).hexdigest()

    def _name(self, file: Path) -> str:
        beside = file.parent == self.path.parent
        return f"../{file.name}" if beside else file.relative_to(self.path).as_posix()


def file_sha256(file: Path) -> str:
    """SHA-256 of a file's bytes, in hexadecimal."""
    with file.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def _files(paths: Iterable[Path]) -> list[Path]:
    return [path for path in paths if path.is_file()]


def _image_names(file: Path) -> list[str]:
    """The column `file` of images.csv; none where the table is not as the format says."""
    if not file.is_file():
        return []
    try:
        with file.open(newline="", encoding="utf-8-sig") as stream:
            names = [unquoted_text(row.get("file") or "") for row in csv.DictReader(stream)]
    except (OSError, UnicodeDecodeError, csv.Error):
        return []
    return [name for name in names if name and "\0" not in name and not Path(name).is_absolute()]
