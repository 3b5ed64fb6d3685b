"""A model of feel as a file of arrays and JSON, and back."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.errors import OdometryError
from odometry.feel.design import Design
from odometry.feel.discriminant import Discriminant
from odometry.feel.evidence import Calibration
from odometry.feel.limits import Limits
from odometry.feel.members import Choice, Members
from odometry.feel.model import FeelModel
from odometry.feel.motion_features import SPEED_NAMES
from odometry.feel.strangeness import TERMS, Strangeness
from odometry.io.array_file import FileKind, read_array_file, write_array_file


class FeelFileError(OdometryError):
    """A file of how terrains feel is damaged, foreign, or newer than this program."""


FEEL = FileKind("terrain-odometry feel", 2, "model of feel", FeelFileError)


def write_feel_model(
    path: str | Path, model: FeelModel, made: Mapping[str, Any] | None = None
) -> None:
    """Write a model, whole or not at all; `made` says what made it, and no reader needs it.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> import odometry
    >>> model = odometry.read_feel_model(odometry.shipped_data() / "feel" / "demo.feel")
    >>> with TemporaryDirectory() as folder:
    ...     odometry.write_feel_model(Path(folder) / "my.feel", model)
    ...     odometry.read_feel_model(Path(folder) / "my.feel").names
    ('grass', 'gravel')
    """
    arrays: dict[str, AnyArray] = {}
    pairs = zip(model.members.discriminants, model.members.usual, strict=True)
    for place, (one, usual) in enumerate(pairs):
        arrays |= {
            f"slopes_{place}": one.slopes,
            f"means_{place}": one.means,
            f"whitening_{place}": one.whitening,
            f"usual_{place}": usual,
        }
    arrays |= {
        "strangeness_window": model.strangeness.window,
        "strangeness_stretch": model.strangeness.stretch,
    }
    write_array_file(Path(path), FEEL, _settings(model), arrays, made)


def read_feel_model(path: str | Path) -> FeelModel:
    """Read what `write_feel_model` wrote.

    Raises
    ------
    FeelFileError
        If the file is missing, damaged, foreign, or of a newer program. Nothing in it is executed.

    Examples
    --------
    >>> import odometry
    >>> try:
    ...     odometry.read_feel_model("nowhere.feel")
    ... except odometry.OdometryError as error:
    ...     print(error)
    nowhere.feel: cannot be read: No such file or directory
    """
    settings, arrays = read_array_file(Path(path), FEEL)
    try:
        return _model(settings, arrays)
    except (KeyError, TypeError, ValueError, IndexError) as error:
        raise FeelFileError(f"{path}: its settings or arrays do not fit: {error!r}") from error


def is_feel_model(path: Path) -> bool:
    """Whether a file is a whole model of a format that this program reads."""
    try:
        read_feel_model(path)
    except FeelFileError:
        return False
    return True


def _settings(model: FeelModel) -> dict[str, Any]:
    return {
        "names": list(model.names),
        "window_s": model.design.window_s,
        "axes": list(model.design.axes),
        "motion": list(model.design.motion),
        "top_hz": model.design.top_hz,
        "layouts": list(model.design.layouts),
        "shaped": model.design.shaped,
        "sets": [list(one) for one in model.choice.sets],
        "shrinkage": model.choice.shrinkage,
        "unknown_share": model.strangeness.share,
        "calibration": vars(model.calibration),
        "limits": vars(model.limits),
        "track_width_m": model.track_width_m,
        "robot": model.robot,
        "source": model.source,
        "report": dict(model.report),
    }


def _model(settings: dict[str, Any], arrays: dict[str, AnyArray]) -> FeelModel:
    names = tuple(map(str, settings["names"]))
    design = Design(
        float(settings["window_s"]),
        tuple(map(str, settings["axes"])),
        tuple(map(str, settings["motion"])),
        float(settings["top_hz"]),
        tuple(map(int, settings["layouts"])),
        bool(settings.get("shaped", False)),
    )
    sets = tuple(tuple(map(str, one)) for one in settings["sets"])
    choice = Choice(sets, float(settings["shrinkage"]))
    discriminants, usual = [], []
    for place, (_, columns) in enumerate(choice.parts(design)):
        size, covariates = len(columns), len(SPEED_NAMES)
        shapes = {
            "slopes": (covariates, size),
            "means": (len(names), size),
            "whitening": (size, size),
            "usual": (size + covariates,),
        }
        of = {name: _array(arrays, f"{name}_{place}", shape) for name, shape in shapes.items()}
        discriminants.append(Discriminant(of["slopes"], of["means"], of["whitening"]))
        usual.append(of["usual"])
    return FeelModel(
        names,
        design,
        choice,
        Members(tuple(discriminants), tuple(usual)),
        Calibration(**{name: float(one) for name, one in settings["calibration"].items()}),
        _strangeness(settings, arrays),
        Limits(**{name: float(one) for name, one in settings["limits"].items()}),
        float(settings["track_width_m"]),
        str(settings["robot"]),
        str(settings["source"]),
        dict(settings["report"]),
    )


def _strangeness(settings: dict[str, Any], arrays: Mapping[str, AnyArray]) -> Strangeness:
    """Version 1 had none."""
    if "strangeness_window" not in arrays:
        return Strangeness.none()
    weights = [_array(arrays, f"strangeness_{one}", (TERMS,)) for one in ("window", "stretch")]
    return Strangeness(weights[0], weights[1], float(settings["unknown_share"]))


def _array(arrays: Mapping[str, AnyArray], name: str, shape: tuple[int, ...]) -> FloatArray:
    if arrays[name].shape != shape:
        raise ValueError(f"{name} of shape {arrays[name].shape}, expected {shape}")
    return arrays[name].astype(np.float64)
