"""A command as it was given, before anything that it names is read."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from odometry.outputs.inputs import Input
from odometry.outputs.made import Made, installed_packages


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
