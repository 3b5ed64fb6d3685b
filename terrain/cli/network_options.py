"""Options that choose an image network as what `train` makes features with."""

from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from terrain.classification.network_features import NetworkFeatures


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
        help="Of this network.  [default: those before the first strides]",
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
    from terrain.classification.network_features import NetworkFeatures

    low, _, high = (input_range or "-1:1").partition(":")
    try:
        limits = float(low), float(high)
    except ValueError:
        raise click.BadParameter(
            f"{input_range!r}, expected LOW:HIGH such as 0:1", param_hint="--input-range"
        ) from None
    names = tuple(name.strip() for name in (layers or "").split(",") if name.strip())
    return NetworkFeatures(network, layers=names, input_range=limits).read_network()
