"""What a model file says beside its arrays, checked when it is read."""

import sys
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from types import UnionType
from typing import Any, Self, get_args, get_origin, get_type_hints

import numpy as np

from odometry.arrays import AnyArray
from terrain.classification.features.features import FeatureSettings
from terrain.classification.features.network_features import Network, NetworkFeatures
from terrain.classification.neighbours.calibration import TEMPERATURES
from terrain.classification.neighbours.rejection import PATCHES
from terrain.classification.photographs.trained_on import TrainedOn

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
    """The settings of a trained classifier: attributes of `TerrainClassifier`, keys of its file.

    What has a default is missing from files of older versions: `trained_on` from those of 0.4,
    `rejection_distances` and `temperature` of 0.9, `one_patch` of 0.11,
    `image_rejection_distances` of 0.12, and `noticed_share` of 0.33.
    """

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
    noticed_share: float | None = None

    @classmethod
    def taken_from(cls, model: object, features: FeatureSettings | NetworkSettings) -> Self:
        """The settings of a trained classifier, whose attribute `classes_` is an array."""
        values = {name: getattr(model, of) for name, of in ATTRIBUTES.items()}
        values["classes"] = tuple(map(str, values["classes"]))
        return cls(features=features, **values)

    def put_into(self, model: object) -> None:
        """Set the attributes of a classifier, but for what makes its features."""
        for name, attribute in ATTRIBUTES.items():
            setattr(model, attribute, getattr(self, name))

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
        values: dict[str, Any] = {
            of.name: tuple(value) if isinstance(value := table[of.name], list) else value
            for of in fields(cls)
            if of.name in table
        }
        values.setdefault("rejection_distances", (table["rejection_distance"],))
        values["features"] = read_features(table["features"])
        if values.get("trained_on") is not None:
            values["trained_on"] = TrainedOn.from_table(values["trained_on"])
        settings = cls(**values)
        settings._check()
        return settings

    def _check(self) -> None:
        for name, kind in get_type_hints(type(self)).items():
            value, kinds = getattr(self, name), _plain_kinds(kind)
            if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
                raise TypeError(f"{name} is {value!r}")
        if not all(isinstance(name, str) for name in self.classes):
            raise TypeError(f"classes are {self.classes}")
        for name, (low, high) in RANGES.items():
            values = getattr(self, name)
            for value in values if isinstance(values, tuple) else (values,):
                if value is not None and not low <= value <= high:
                    raise ValueError(f"{name} = {value}, expected {low:g} to {high:g}")
        limits, of_images = self.rejection_distances, self.image_rejection_distances
        if len(limits) not in {1, len(PATCHES)}:
            raise ValueError(f"rejection distances {limits}")
        if of_images is not None and len(of_images) != len(PATCHES):
            raise ValueError(f"rejection distances of images {of_images}")


def _plain_kinds(kind: Any) -> tuple[type, ...]:
    """The classes of a type such as ``tuple[str, ...] | None``; a float may be a whole number."""
    kinds = get_args(kind) if isinstance(kind, UnionType) else (kind,)
    plain = tuple(get_origin(of) or of for of in kinds)
    return (*plain, int) if float in plain else plain


SMALLEST, LARGEST = sys.float_info.min, sys.float_info.max
RANGES = {
    "metres_per_pixel": (SMALLEST, LARGEST),
    "rejected_share": (SMALLEST, 1 - sys.float_info.epsilon),
    "patch_size_px": (1, 4096),
    "n_neighbors": (1, 10_000),
    "rejection_distance": (0.0, 1e12),
    "rejection_distances": (0.0, 1e12),
    "temperature": TEMPERATURES,
    "image_rejection_distances": (0.0, 1e12),
    "noticed_share": (0.0, 1.0),
}
# What was learned has an underscore at the end, as scikit-learn has it.
GIVEN = {"preset", "metres_per_pixel", "rejected_share", "patch_size_px"}
ATTRIBUTES = {
    of.name: of.name if of.name in GIVEN else f"{of.name}_"
    for of in fields(ModelSettings)
    if of.name != "features"
}
