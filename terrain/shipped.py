"""The data that is shipped: beside the packages in a checkout, inside `terrain` once installed."""

from pathlib import Path

from terrain.errors import TerrainError


def shipped_data() -> Path:
    """The folder that holds `runs`, `patches`, `parameters`, `vehicles` and `cameras`.

    Raises
    ------
    TerrainError
        If the installation has none.

    Examples
    --------
    >>> import terrain
    >>> sorted(folder.name for folder in terrain.shipped_data().iterdir() if folder.is_dir())
    ['bags', 'cameras', 'parameters', 'patches', 'runs', 'vehicles']
    """
    package = Path(__file__).resolve().parent
    for folder in (package / "data", package.parent / "data"):
        if (folder / "README.md").is_file():
            return folder
    raise TerrainError(f"the shipped data is not beside {package}; install the package anew")
