"""The names that each verb gives to what it writes, and folders that version 0.4 wrote.

Version 0.4 left no manifest in its output folders. They are known by their result file, and of
what lies in them only files of these names are taken for the program's own.
"""

from collections.abc import Callable
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from odometry.errors import OdometryError
from odometry.io.formats import PROGRAM
from odometry.io.structured import read_json

RUN_NAMES = (
    *("odometer.csv", "odometer.tum", "estimate.csv", "estimate.tum", "terrain.csv"),
    *("learned.toml", "result.json", "report.html", "reference.csv", "reference.tum"),
    *(f"figures/{name}.png" for name in ("path", "position_errors", "error_per_metre", "icrs")),
    *(f"figures/{name}.png" for name in ("labels", "confusion", "regions", "whole_image")),
)
MODES_NAMES = (
    *("modes.csv", "modes_with_sight.csv", "result.json", "report.html"),
    *("figures/modes.png", "figures/path.png"),
)
TRAJECTORY_ENDS = (
    ".tum",
    "_kitti.txt",
    "_times.txt",
    "_euroc.csv",
)
RECORDING_NAMES = tuple(f"{name}.csv" for name in ("odometry", "pose", "truth", "images"))
NAMES: dict[str, tuple[str, ...]] = {
    "run": RUN_NAMES,
    "demo": (*RUN_NAMES, "terrain.model", *(f"without_vision/{name}" for name in RUN_NAMES)),
    "camera": (
        *("camera.toml", "camera_before.toml", "figures/terrain_*.png"),
        *(f"figures/{name}.png" for name in ("points", "flow", "chessboard")),
    ),
    "gap": ("gap.json", "model.toml", "report.html", "figures/gap_*.png"),
    "compare": (
        *("comparison.json", "windows.csv", "training_horizons.csv", "report.html"),
        *("parameters/*.toml", "parameters/*/*.toml"),
        *(f"figures/{name}_*.png" for name in ("errors", "speed_plane", "horizons", "rotation")),
        "figures/training_horizons_*.png",
    ),
    "batch": ("batch.csv", "learned.toml", "report.html", "times.csv"),
    "modes": (*MODES_NAMES, "runs.csv", *(f"*/{name}" for name in MODES_NAMES)),
    "export": (
        *("ros.yaml", "results.mcap", "terrain.geojson", "terrain_cells.csv", "*.parquet"),
        *(f"{name}{end}" for name in ("odometer", "estimate") for end in TRAJECTORY_ENDS),
    ),
    "label": ("manifest.csv", "contact_sheet_*.png"),
    "import": (
        *("run.toml", "imu.csv", *RECORDING_NAMES, "other_odometry/*.csv"),
        *("images/*.jpg", "images/*.png"),
    ),
    "simulate": ("run.toml", *RECORDING_NAMES),
    "synthesise": (
        *("run.toml", *RECORDING_NAMES, "parameters.toml", "images/*.jpg"),
        *("patches/manifest.csv", "patches/*/*.jpg"),
    ),
}


def has_own_name(verb: str, name: str) -> bool:
    """Whether a relative name, with slashes, is one that the verb may write."""
    return any(
        name.count("/") == pattern.count("/") and fnmatchcase(name, pattern)
        for pattern in NAMES.get(verb, ())
    )


def files_of_version_0_4(folder: Path, verb: str) -> tuple[str, ...]:
    """Names of the files that version 0.4 wrote into a folder; none where the verb did not."""
    made = WROTE.get(verb)
    if made is None or not made(folder):
        return ()
    names = (f.relative_to(folder).as_posix() for f in sorted(folder.rglob("*")) if f.is_file())
    return tuple(name for name in names if has_own_name(verb, name))


def _content(file: Path) -> dict[str, Any]:
    try:
        content = read_json(file, OdometryError)
    except OdometryError:
        return {}
    return content if isinstance(content, dict) else {}


def _wrote_run(folder: Path) -> bool:
    content = _content(folder / "result.json")
    return str(content.get("program")).startswith(f"{PROGRAM} ") and "errors" in content


def _wrote_demo(folder: Path) -> bool:
    return _wrote_run(folder) and _wrote_run(folder / "without_vision")


def _wrote_modes(folder: Path) -> bool:
    if (folder / "runs.csv").is_file():
        return any(map(_wrote_modes_of_one, sorted(folder.iterdir())))
    return _wrote_modes_of_one(folder)


def _wrote_modes_of_one(folder: Path) -> bool:
    content = _content(folder / "result.json")
    return str(content.get("program")).startswith(f"{PROGRAM} ") and "motion" in content


def _wrote_gap(folder: Path) -> bool:
    return {"verdict", "effects", "where", "gap", "holdout"} <= set(_content(folder / "gap.json"))


def _wrote_compare(folder: Path) -> bool:
    keys = {"version", "places", "by_horizon", "splits"}
    return keys <= set(_content(folder / "comparison.json"))


WROTE: dict[str, Callable[[Path], bool]] = {
    "run": lambda folder: _wrote_run(folder) and not _wrote_demo(folder),
    "demo": _wrote_demo,
    "modes": _wrote_modes,
    "gap": _wrote_gap,
    "compare": _wrote_compare,
}
