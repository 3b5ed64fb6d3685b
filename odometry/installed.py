"""What is installed: optional packages, named with their extra where missing, and shipped data."""

from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from odometry.errors import ExtraError, OdometryError


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


def shipped_data() -> Path:
    """The folder of examples: runs, patches, parameters, modes, feel, vehicles, cameras and bags.

    Raises
    ------
    OdometryError
        If the installation has none.

    Examples
    --------
    >>> import odometry
    >>> sorted(folder.name for folder in odometry.shipped_data().iterdir() if folder.is_dir())
    ['bags', 'cameras', 'feel', 'modes', 'parameters', 'patches', 'runs', 'vehicles']
    """
    package = Path(__file__).resolve().parent
    for folder in (package / "data", package.parent / "data"):
        if (folder / "README.md").is_file():
            return folder
    raise OdometryError(f"the shipped data is not beside {package}; install the package again")
