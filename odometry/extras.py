"""Optional packages: imported where they are used, and named with their extra where missing."""

from importlib import import_module
from importlib.util import find_spec
from typing import Any

from odometry.errors import ExtraError


def extra_module(name: str, extra: str, purpose: str) -> Any:
    """Import a package that an extra of this distribution brings.

    Parameters
    ----------
    name : str
        Of the module.
    extra : str
        Of pyproject.toml.
    purpose : str
        What it is needed for, for the message.

    Raises
    ------
    ExtraError
        If it is not installed.
    """
    package = name.partition(".")[0]
    if find_spec(package) is None:
        raise ExtraError(
            f"{purpose} needs the package {package}, which is not installed: "
            f"pip install 'terrain-odometry[{extra}]'"
        )
    return import_module(name)
