"""Settings of features in a model file, and the image network in it where one makes them."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from odometry.arrays import AnyArray
from terrain.classification.features import FeatureSettings
from terrain.classification.network_features import Network, NetworkFeatures

ARRAY = "network"  # its bytes, in the model file


@dataclass(frozen=True)
class NetworkSettings:
    """An image network in a model file.

    Attributes
    ----------
    network : str
        Name of the file that it was read from.
    sha256 : str
        Of the part of it that the model holds.
    layers : tuple of str
    input_range : (float, float)
    """

    network: str
    sha256: str
    layers: tuple[str, ...]
    input_range: tuple[float, float]

    @classmethod
    def taken_from(cls, features: NetworkFeatures) -> tuple[Self, dict[str, AnyArray]]:
        """The settings of fitted features, and the array that holds their network."""
        part, (low, high) = features.part_, features.input_range
        settings = cls(part.name, part.sha256, features.layers_, (float(low), float(high)))
        return settings, {ARRAY: np.frombuffer(part.data, np.int8)}

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Self:
        """Read what `dataclasses.asdict` and JSON made; KeyError, TypeError, ValueError if not."""
        low, high = map(float, table["input_range"])
        return cls(
            str(table["network"]),
            str(table["sha256"]),
            tuple(map(str, table["layers"])),
            (low, high),
        )

    def restored(self, arrays: dict[str, AnyArray]) -> NetworkFeatures:
        """Fitted features by the network among the arrays of the same file.

        Raises
        ------
        KeyError, ValueError, NetworkError
            If it is missing, another one, or none that can be run.
        """
        network = Network(self.network, arrays[ARRAY].astype(np.int8).tobytes())
        if network.sha256 != self.sha256:
            raise ValueError(f"its network is not the part of {self.network} that it was made with")
        return NetworkFeatures(
            network, layers=self.layers, input_range=self.input_range
        ).read_network()


def read_features(table: Mapping[str, Any]) -> FeatureSettings | NetworkSettings:
    """Read the settings of features; KeyError, TypeError, ValueError if they are none."""
    return (NetworkSettings if ARRAY in table else FeatureSettings).from_table(table)
