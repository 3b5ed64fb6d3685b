"""What a model file says beside its arrays, checked when it is read."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Self

from terrain.classification.features import FeatureSettings


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
    features: FeatureSettings

    def to_table(self) -> dict[str, Any]:
        """Turn into values that JSON can hold."""
        return asdict(self)

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
        if table["patch_size_px"] < 1 or table["n_neighbors"] < 1:
            raise ValueError("patch_size_px and n_neighbors must be at least 1")
        values = {name: table[name] for name in kinds}
        values["classes"] = tuple(map(str, table["classes"]))
        values["features"] = FeatureSettings.from_table(table["features"])
        return cls(**values)
