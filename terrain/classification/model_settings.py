"""What a model file says beside its arrays, checked when it is read."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Self

import numpy as np

from odometry.arrays import AnyArray
from terrain.classification.calibration import TEMPERATURES
from terrain.classification.features import FeatureSettings
from terrain.classification.network_features import Network, NetworkFeatures
from terrain.classification.rejection import PATCHES
from terrain.classification.trained_on import TrainedOn

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


@dataclass(frozen=True)
class ModelSettings:
    """The settings of a trained classifier, as `TerrainClassifier` names them."""

    preset: str
    colour: bool
    metres_per_pixel: float | None
    rejected_share: float
    patch_size_px: int
    classes: tuple[str, ...]
    n_neighbors: int
    rejection_distance: float
    features: FeatureSettings | NetworkSettings
    trained_on: TrainedOn | None = None
    rejection_distances: tuple[float, ...] = ()
    temperature: float | None = None
    one_patch: bool = False
    image_rejection_distances: tuple[float, ...] | None = None

    def to_table(self) -> dict[str, Any]:
        """Turn into values that JSON can hold."""
        return asdict(self) | {"trained_on": self.trained_on and self.trained_on.to_table()}

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Self:
        """Read what `to_table` gave.

        Raises
        ------
        KeyError, TypeError, ValueError
            If a setting is missing, of another kind, or out of range.
        """
        kinds: dict[str, type | tuple[type, ...]] = {
            "preset": str,
            "colour": bool,
            "metres_per_pixel": (float, int, type(None)),
            "rejected_share": float,
            "patch_size_px": int,
            "classes": list,
            "n_neighbors": int,
            "rejection_distance": float,
            "features": dict,
        }
        for name, kind in kinds.items():
            if not isinstance(table[name], kind):
                raise TypeError(f"{name} is {table[name]!r}")
        limits = {
            "patch_size_px": (1, 4096),
            "n_neighbors": (1, 10_000),
            "rejection_distance": (0.0, 1e12),
        }
        for name, (low, high) in limits.items():
            if not low <= table[name] <= high:
                raise ValueError(f"{name} = {table[name]}, expected {low:g} to {high:g}")
        if not 0 < table["rejected_share"] < 1:
            raise ValueError(f"rejected_share = {table['rejected_share']}, expected 0 to 1")
        if table["metres_per_pixel"] is not None and not 0 < table["metres_per_pixel"] < math.inf:
            raise ValueError(f"metres_per_pixel = {table['metres_per_pixel']}, expected above 0")
        values = {name: table[name] for name in kinds}
        values["classes"] = tuple(map(str, table["classes"]))
        values["features"] = read_features(table["features"])
        if table.get("trained_on") is not None:  # files of version 0.4 do not say
            values["trained_on"] = TrainedOn.from_table(table["trained_on"])
        # files of version 0.9 do not say
        limits = table.get("rejection_distances", [table["rejection_distance"]])
        values["rejection_distances"] = _distances(limits, {1, len(PATCHES)})
        if table.get("temperature") is not None:
            values["temperature"] = _within(table["temperature"], *TEMPERATURES)
        # files of version 0.11 do not say
        values["one_patch"] = _is_true(table.get("one_patch", False))
        if table.get("image_rejection_distances") is not None:  # files of 0.12 do not say
            limits = table["image_rejection_distances"]
            values["image_rejection_distances"] = _distances(limits, {len(PATCHES)})
        return cls(**values)


def _distances(limits: Sequence[object], lengths: set[int]) -> tuple[float, ...]:
    if len(limits) not in lengths:
        raise ValueError(f"rejection distances {limits}")
    return tuple(_within(limit, 0.0, 1e12) for limit in limits)


def _is_true(value: object) -> bool:
    if not isinstance(value, bool):
        raise TypeError(f"one_patch is {value!r}")
    return value


def _within(value: object, low: float, high: float) -> float:
    if not isinstance(value, float) or not low <= value <= high:
        raise ValueError(f"{value!r}, expected a number from {low:g} to {high:g}")
    return value
