"""What made an output: verb, command, inputs, packages, and the identity that they give."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from odometry.checks.finding import CheckReport
from odometry.outputs.inputs import Input
from odometry.outputs.manifest import PROGRAM

PACKAGES = ("numpy", "scipy", "scikit-learn", "scikit-image", "filterpy")
OPENCV = ("opencv-python-headless", "opencv-python", "opencv-contrib-python-headless")


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


def about_result(made: Made, reports: Sequence[CheckReport]) -> dict[str, Any]:
    """Keys that are added to a result file, of plain values."""
    return {"made": made.to_table(), "check": [report.to_table() for report in reports]}


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
