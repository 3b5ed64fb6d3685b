"""The data that is shipped: beside the packages in a checkout, inside `odometry` once installed."""

from pathlib import Path

from odometry.errors import OdometryError


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
