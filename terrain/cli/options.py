"""Options that several commands share."""

import math
from collections.abc import Callable, Sequence
from difflib import get_close_matches
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from terrain.classification.features.network_features import NetworkFeatures

# Those of odometry.models.catalogue, which is too slow to import for a --help.
MODEL_NAMES = (
    *("differential_drive", "icr_symmetric", "icr", "radius_of_curvature", "full_linear"),
    *("icr_slope", "icr_inertia", "icr_inertia_measured", "traction_mode", "contact"),
)


# What exists at the place of an output is refused where it is claimed, with one exit code.
OUTPUT = click.Path(path_type=Path)


def processes_option(command: Callable[..., None]) -> Callable[..., None]:
    """Add --processes, on which no result depends."""
    return click.option(
        "--processes",
        type=click.IntRange(min=1),
        metavar="N",
        help="How many processes work at a time.  [default: one for each core]",
    )(command)


def scheduler_option(command: Callable[..., None]) -> Callable[..., None]:
    """Add --scheduler, on which no result depends."""
    return click.option(
        "--scheduler",
        metavar="ADDRESS",
        help="Dask scheduler whose workers do the work instead, such as tcp://host:8786.",
    )(command)


class Positive(click.FloatRange):
    """A number well above zero that is finite: click lets nan and inf pass."""

    def __init__(self, largest: float) -> None:
        super().__init__(min=1e-6, max=largest)

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """The number, or click's error."""
        number = float(super().convert(value, param, ctx))
        if math.isnan(number):
            self.fail("nan is no number above zero", param, ctx)
        return number


def require_model(text: str) -> None:
    """Raise click's error unless it names a model or ends in .toml, before any run is read."""
    if text in MODEL_NAMES or Path(text).suffix == ".toml":
        return
    near = get_close_matches(text, MODEL_NAMES, n=1)
    meant = f"did you mean {near[0]}? Known: " if near else "known: "
    raise click.BadParameter(
        f"there is no model {text!r}; {meant}{', '.join(MODEL_NAMES)}, or a parameter set (.toml)",
        param_hint="--model",
    )


def assignments(texts: Sequence[str]) -> dict[str, float]:
    """Values by name, from texts like mu=0.6."""
    values = {}
    for text in texts:
        name, _, number = text.partition("=")
        try:
            values[name.strip()] = float(number)
        except ValueError:
            raise click.BadParameter(
                f"{text!r}, expected NAME=VALUE with a number", param_hint="--fix"
            ) from None
    return values


def trajectory_options(command: Callable[..., None]) -> Callable[..., None]:
    """Add --times and --axes of trajectory files; the command gets them as `times` and `axes`."""

    @click.option(
        "--times",
        type=click.Path(exists=True, dir_okay=False, path_type=Path),
        help="Stamps of a KITTI file, one a line [s].",
    )
    @click.option(
        "--axes",
        type=click.Choice(["robot", "optical"]),
        help="Of these files: x forward and z up, or those of images, z the viewing direction "
        "and y down.  [default: optical of KITTI, else robot]",
    )
    @wraps(command)
    def with_form(*, times: Path | None, axes: str | None, **others: Any) -> None:
        command(times=times, axes=axes or "", **others)

    return with_form


def window_options(command: Callable[..., None]) -> Callable[..., None]:
    """Add the options that cut runs into windows; the command gets them as `windows`."""

    @click.option(
        "--horizon",
        "horizon_m",
        type=float,
        help="Wheel travel of a window [m]: 2, or less where there are too few of these.",
    )
    @click.option("--horizon-s", type=float, default=0.0, help="Duration of a window instead [s].")
    @click.option(
        "--stride",
        type=float,
        default=1.0,
        show_default=True,
        help="From the start of a window to that of the next, in horizons.",
    )
    @click.option(
        "--position-sigma",
        type=float,
        default=0.02,
        show_default=True,
        help="Standard deviation of a measured position [m].",
    )
    @click.option(
        "--yaw-sigma",
        type=float,
        default=0.01,
        show_default=True,
        help="Standard deviation of a measured heading [rad].",
    )
    @wraps(command)
    def with_windows(
        *,
        horizon_m: float | None,
        horizon_s: float,
        stride: float,
        position_sigma: float,
        yaw_sigma: float,
        **others: Any,
    ) -> None:
        from odometry.windows.config import WindowConfig

        windows = WindowConfig(
            horizon_m=horizon_m,
            horizon_s=horizon_s,
            stride=stride,
            position_sigma_m=position_sigma,
            yaw_sigma_rad=yaw_sigma,
        )
        command(windows=windows, **others)

    return with_windows


def network_options(command: Callable[..., None]) -> Callable[..., None]:
    """Add --features, --layers and --input-range; the command gets a transformer or None."""

    @click.option(
        "--features",
        "network",
        type=click.Path(path_type=Path),
        metavar="FILE.onnx",
        help="An image network of your own, run by OpenCV: its layers are the features in place of "
        "SFTA. Copied into the model.",
    )
    @click.option(
        "--layers",
        metavar="NAME,...",
        help="Layers of this network.  [default: those before the first strides]",
    )
    @click.option(
        "--input-range",
        metavar="LOW:HIGH",
        help="Values of 0 and 255 at the network's input.  [default: -1:1]",
    )
    @wraps(command)
    def with_network(
        *, network: Path | None, layers: str | None, input_range: str | None, **others: Any
    ) -> None:
        if network is None and (layers or input_range):
            option = "--layers" if layers else "--input-range"
            raise click.UsageError(f"{option} is of a network: give --features FILE.onnx")
        features = None if network is None else _features(network, layers, input_range)
        command(features=features, **others)

    return with_network


def _features(network: Path, layers: str | None, input_range: str | None) -> "NetworkFeatures":
    from terrain.classification.features.network_features import NetworkFeatures

    low, _, high = (input_range or "-1:1").partition(":")
    try:
        limits = float(low), float(high)
    except ValueError:
        raise click.BadParameter(
            f"{input_range!r}, expected LOW:HIGH such as 0:1", param_hint="--input-range"
        ) from None
    names = tuple(name.strip() for name in (layers or "").split(",") if name.strip())
    return NetworkFeatures(network, layers=names, input_range=limits).read_network()
