"""Whether a path that a file names stays in its folder."""

import os
from pathlib import Path


def leads_out(folder: Path, name: str) -> bool:
    """Whether `folder / name` lies outside of the folder, by `..` or by symbolic links.

    The folder itself may be reached through a symbolic link.
    """
    return not Path(os.path.realpath(folder / name)).is_relative_to(os.path.realpath(folder))
