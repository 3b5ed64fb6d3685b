"""Features of patches by the layers of an image network, run by OpenCV."""

import hashlib
import threading
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any, Self

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray
from odometry.errors import ConfigError
from odometry.io.files import read_bytes
from terrain.classification.features.onnx_graph import (
    before_halvings,
    layers_of,
    outputs_of,
    part_leading_to,
    tensors_of,
)
from terrain.errors import ImageError, NetworkError
from terrain.images import to_bytes
from terrain.texture.transformer import ImageTransformer, listed_images, naming_image

NETWORK_BYTES = 1024**3
MOST_LAYERS = 4  # that are chosen where none are named
PROBE_PX = 64


@dataclass(frozen=True)
class Network:
    """The bytes of an ONNX file, and the name by which messages call it.

    Attributes
    ----------
    name : str
    data : bytes
    sha256 : str
    """

    name: str
    data: bytes = field(repr=False)

    @classmethod
    def read(cls, path: str | Path) -> Self:
        """Read a file; NetworkError if it cannot be read."""
        data = read_bytes(Path(path), NetworkError, NETWORK_BYTES, "a network has a few million")
        return cls(Path(path).name, data)

    @cached_property
    def sha256(self) -> str:
        """Of the data."""
        return hashlib.sha256(self.data).hexdigest()


class NetworkFeatures(ImageTransformer):
    """Mean and standard deviation over the patch of the channels of an image network's layers.

    The network is frozen: nothing of it is learned. It runs patch by patch on the patch's own
    pixels, so that the features of a patch do not depend on its neighbours; patches of one size
    give features that can be compared. A grey patch is shown as three equal channels.

    Parameters
    ----------
    network : path or Network
        An ONNX file with one input, (1, 3, rows, columns), RGB.
    layers : sequence of str
        Names of layers (nodes or tensors) whose outputs are maps; by default the first four of
        those that a stride makes smaller and what the network gives, where that is a map.
    input_range : (float, float)
        The values that 0 and 255 become at the input of the network, as it was trained.

    Attributes
    ----------
    part_ : Network
        What of the network leads to the layers.
    layers_ : tuple of str
        Tensors of the network.
    channels_ : tuple of int
        Of each layer.

    Examples
    --------
    >>> import terrain
    >>> try:
    ...     terrain.NetworkFeatures("nowhere.onnx").read_network()
    ... except terrain.TerrainError as error:
    ...     print("cannot be read" in str(error))
    True

    References
    ----------
    Cimpoi, Maji, Kokkinos and Vedaldi 2016, "Deep filter banks for texture recognition": pooled
    responses of early layers distinguish textures.
    """

    def __init__(
        self,
        network: str | Path | Network,
        *,
        layers: tuple[str, ...] = (),
        input_range: tuple[float, float] = (-1.0, 1.0),
    ) -> None:
        self.network = network
        self.layers = layers
        self.input_range = input_range

    def read_network(self) -> Self:
        """Read the network, cut it off behind the layers, and try it on a blank patch.

        Raises
        ------
        ConfigError
            If the range is none.
        NetworkError
            If the file is no network, has no such layers, or they are no maps.
        """
        low, high = self.input_range
        if not -1e6 < low < high < 1e6:
            raise ConfigError(f"input_range is {self.input_range}, expected low and high")
        given = self.network
        network = given if isinstance(given, Network) else Network.read(given)
        try:
            if self.layers:
                return self._end_at(network, self.layers)
            halved = before_halvings(layers_of(network.data), MOST_LAYERS)
            try:
                return self._end_at(network, (*halved, *outputs_of(network.data))[:MOST_LAYERS])
            except (NetworkError, ImageError):  # what the network gives is no map
                if not halved:
                    raise
                return self._end_at(network, halved)
        except (NetworkError, ImageError) as error:
            raise NetworkError(f"{network.name}: {error}") from error

    def _end_at(self, network: Network, names: tuple[str, ...]) -> Self:
        self.layers_ = tensors_of(layers_of(network.data), tuple(dict.fromkeys(names)))
        self.part_ = Network(network.name, part_leading_to(network.data, self.layers_))
        blank = np.zeros((PROBE_PX, PROBE_PX), np.uint8)
        self.channels_ = tuple(of.shape[1] for of in self._maps(blank))
        return self

    def transform(self, X: Iterable[AnyArray]) -> FloatArray:
        """Give the features of each image.

        Parameters
        ----------
        X : list of images, or array (N, H, W) or (N, H, W, 3)
            Grey or RGB.

        Returns
        -------
        (N, n_features) array of float64
            Of each layer the means of its channels, then their deviations.

        Raises
        ------
        ImageError
            There is no image, or the network cannot work on one of this size.
        NetworkError, ConfigError
            As `read_network`, which is called where the network is not yet read.
        """
        if not hasattr(self, "part_"):
            self.read_network()
        rows = []
        for place, image in enumerate(listed_images(X)):
            with naming_image(place):
                rows.append(self._features(to_bytes(image)))
        return np.stack(rows)

    def _names(self) -> list[str]:
        self.read_network()
        return [
            f"{layer}_{quantity}_{channel}"
            for layer, count in zip(self.layers_, self.channels_, strict=True)
            for quantity in ("mean", "deviation")
            for channel in range(count)
        ]

    @property
    def described(self) -> str:
        """Network, layers and number of features as a text, once the network is read."""
        return (
            f"mean and deviation of the {sum(self.channels_)} channels of layers "
            f"{', '.join(self.layers_)} of {self.part_.name}"
        )

    def _features(self, image: ByteImage) -> FloatArray:
        flat = [of[0].reshape(of.shape[1], -1).astype(np.float64) for of in self._maps(image)]
        row = np.concatenate([part for of in flat for part in (of.mean(axis=1), of.std(axis=1))])
        if not np.isfinite(row).all():
            raise NetworkError("it gives numbers that are not finite; see the range of its input")
        return row

    def _maps(self, image: ByteImage) -> list[AnyArray]:
        """The layers, each (1, channels, rows, columns)."""
        try:
            maps = _forward(self.part_.data, self.layers_, self._input(image))
        except cv2.error as error:
            rows, columns = image.shape[:2]
            reason = " ".join(str(error).split())
            raise ImageError(
                f"OpenCV cannot run the network on {columns} x {rows} pixels: {reason}"
            ) from error
        for name, of in zip(self.layers_, maps, strict=True):
            if of.ndim != 4 or len(of) != 1:
                raise NetworkError(f"layer '{name}' gives {of.shape}, no map of channels")
        return maps

    def _input(self, image: ByteImage) -> AnyArray:
        low, high = self.input_range
        grey = image[..., None] if image.ndim == 2 else image
        channels = np.broadcast_to(grey[..., :3], (*image.shape[:2], 3))
        scaled = low + (high - low) / 255 * channels.astype(np.float32)
        return np.ascontiguousarray(scaled.transpose(2, 0, 1)[None], dtype=np.float32)


def _forward(network: bytes, layers: tuple[str, ...], blob: AnyArray) -> list[AnyArray]:
    loaded = _loaded(network, threading.get_ident())
    loaded.setInput(blob)
    return list(loaded.forward(list(layers)))


@lru_cache(maxsize=4)
def _loaded(network: bytes, thread: int) -> Any:  # noqa: ARG001 - a network serves one thread
    return cv2.dnn.readNetFromONNX(np.frombuffer(network, np.uint8))
