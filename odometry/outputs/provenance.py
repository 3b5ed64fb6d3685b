"""What made an output: verb, command, files and their SHA-256, packages, and its identity."""

import csv
import hashlib
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from odometry.io.csv_columns import unquoted_text
from odometry.io.formats import PROGRAM
from odometry.io.run_folder import FILES

PACKAGES = ("numpy", "scipy", "scikit-learn", "scikit-image", "filterpy")
OPENCV = ("opencv-python-headless", "opencv-python", "opencv-contrib-python-headless")

RUN_FILES = ("run.toml", *(f"{name}.csv" for name in FILES))
RESULT_FILES = (
    "result.json",
    "learned.toml",
    *(f"{name}.csv" for name in ("odometer", "estimate", "terrain", "reference")),
)
PHOTO_SUFFIXES = (".jpg", ".jpeg", ".png")


@dataclass(frozen=True)
class Made:
    """What made an output; there is no clock and no place in it, so that reruns are the same.

    Attributes
    ----------
    verb : str
    command : str
        As given, without `--out`.
    settings : Mapping
        Every option by name, defaults included; plain values.
    inputs : tuple of (role, path, sha256)
        Paths as given.
    packages : Mapping
        Versions by name.
    """

    verb: str
    command: str
    settings: Mapping[str, Any]
    inputs: tuple[tuple[str, str, str], ...]
    packages: Mapping[str, str]

    @cached_property
    def identity(self) -> str:
        """SHA-256 of all but the paths: the same where verb, inputs, settings, packages are."""
        what = {
            "verb": self.verb,
            "settings": dict(self.settings),
            "inputs": [(role, sha256) for role, _, sha256 in self.inputs],
            "packages": dict(self.packages),
        }
        return hashlib.sha256(json.dumps(what, sort_keys=True).encode()).hexdigest()

    def to_table(self) -> dict[str, Any]:
        """Turn into plain values, for JSON."""
        return {
            "verb": self.verb,
            "identity": self.identity,
            "command": self.command,
            "inputs": [
                {"role": role, "path": path, "sha256": sha256} for role, path, sha256 in self.inputs
            ],
            "packages": dict(self.packages),
        }

    def to_comment(self) -> str:
        """The same as comment lines of TOML; the first names the verb."""
        packages = ", ".join(f"{name} {number}" for name, number in self.packages.items())
        lines = [
            f"{MADE_BY}{self.verb}",
            f"command: {self.command}",
            *(f"{role} {path}: sha256 {sha256}" for role, path, sha256 in self.inputs),
            f"packages: {packages}",
            f"identity: {self.identity}",
        ]
        return "".join(f"# {_one_line(line)}\n" for line in lines)


MADE_BY = f"made by: {PROGRAM} "


def installed_packages() -> dict[str, str]:
    """Versions of this program and of the packages that its numbers depend on."""
    found = {}
    for name in (PROGRAM, *PACKAGES, *OPENCV):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def _one_line(text: str) -> str:
    """Control characters, which a TOML comment may not hold, as escapes."""
    return "".join(c if c.isprintable() or c == " " else ascii(c)[1:-1] for c in text)


def about_result(made: Made, checks: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Keys that are added to a result file: what made it, and tables of the checks of its runs."""
    return {"made": made.to_table(), "check": list(checks)}


@dataclass(frozen=True)
class Asked:
    """What `Made` says, but for the sums of the inputs and the packages.

    Attributes
    ----------
    verb, command, settings
        As in `Made`.
    inputs : tuple of (role, path)
        Paths as given.
    where : Path
        The folder from which they were given.
    """

    verb: str
    command: str
    settings: Mapping[str, Any]
    inputs: tuple[tuple[str, Path], ...]
    where: Path

    def made(self, *, with_images: bool) -> Made:
        """Read the inputs, wherever this process works, and add their sums."""
        sums = [
            (role, str(path), Input.of(role, self.where / path).sha256(with_images=with_images))
            for role, path in self.inputs
        ]
        return Made(self.verb, self.command, self.settings, tuple(sums), installed_packages())


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
