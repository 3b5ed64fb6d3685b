"""Whole systems by name: the settings of a paper, and what they contradict."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from odometry.arrays import ByteImage
from odometry.errors import ConfigError
from odometry.estimation.config import PAPER
from odometry.parameters import ParameterSet
from odometry.recording.run import Run
from terrain.camera.camera import Camera
from terrain.classification.answer import Classification
from terrain.config import Config
from terrain.region.region import NoRegion, predict_region

if TYPE_CHECKING:
    from terrain.classification.classifier import TerrainClassifier

STRAIGHT = np.array([1.0, 0.0, 0.0])


class OnePatchClassifier:
    """Labels an image by one patch in its middle; the label is never `unknown`.

    Parameters
    ----------
    classifier : TerrainClassifier
        Fitted. Its average over patches and its rejection are not used.
    """

    def __init__(self, classifier: "TerrainClassifier") -> None:
        self._classifier = classifier
        self.classes_ = classifier.classes_
        self.colour_ = classifier.colour_
        self.patch_size_px = classifier.patch_size_px
        self.metres_per_pixel = classifier.metres_per_pixel

    def classify(self, images: Sequence[ByteImage]) -> list[Classification]:
        """Classify images of at least the patch size.

        Raises
        ------
        ImageError
            As `TerrainClassifier.classify`.
        """
        answers = self._classifier.classify([self._middle(image) for image in images])
        return [_named(answer) for answer in answers]

    def middle_used(self, shape: tuple[int, int]) -> tuple[int, int]:
        """Rows and columns in the middle of an image of such a shape: one patch."""
        rows, columns = (min(length, self.patch_size_px) for length in shape)
        return rows, columns

    def _middle(self, image: ByteImage) -> ByteImage:
        size = self.patch_size_px
        top, left = (max(0, (length - size) // 2) for length in image.shape[:2])
        return image[top : top + size, left : left + size]


def _named(answer: Classification) -> Classification:
    probabilities = answer.probabilities
    return replace(answer, label=max(probabilities, key=lambda name: probabilities[name]))


@dataclass(frozen=True)
class RunPreset:
    """A published system: what it fixes of the settings; the others stay free.

    Attributes
    ----------
    source : str
    fixed : Mapping of block to Mapping of key to value
    model_preset : str
        What the classifier has to be trained with.
    """

    source: str
    fixed: Mapping[str, Mapping[str, Any]]
    model_preset: str

    @property
    def config(self) -> Config:
        """The default settings with the fixed ones."""
        config = Config()
        blocks = {name: replace(getattr(config, name), **of) for name, of in self.fixed.items()}
        return replace(config, **blocks)


RUN_PRESETS = {
    "chen2023": RunPreset(
        "Chen et al. 2023, 3.1 and 3.2",
        {
            # eq. 4-16: six states, poses alone, fixed noise, no gate
            "filter": PAPER | {"gate_probability": 1.0, "detect_jumps": False},
            "region": {"footprint_scale": 1.2, "per_tread": False},  # 3.2.2, eq. 22
            "switch": {"labels_in_row": 2, "on_arrival": False, "by_shares": False},  # 3.2.3
            "classifier": {"own_statistics": False},
        },
        "chen2023",  # eq. 18-26
    )
}


def run_preset(name: str) -> RunPreset:
    """The preset of a name.

    Raises
    ------
    ConfigError
        If there is none.
    """
    if name not in RUN_PRESETS:
        raise ConfigError(f"preset {name!r} is not one of {', '.join(sorted(RUN_PRESETS))}")
    return RUN_PRESETS[name]


def with_preset(
    name: str,
    run: Run,
    config: Config,
    *,
    source: str,
    model: "TerrainClassifier | None",
    parameters: ParameterSet,
) -> tuple[Config, OnePatchClassifier]:
    """Settings and classifier of a published system on a run.

    Parameters
    ----------
    name : str
    run : Run
    config : Config
        With the fixed settings; others may differ from those of the preset.
    source : str
        Source of the terrain.
    model : TerrainClassifier or None
    parameters : ParameterSet

    Raises
    ------
    ConfigError
        If a fixed setting has another value, the terrain does not come from the camera, the model
        was trained in another way, there is a parameter set, or no look-ahead time fits.
    """
    preset = run_preset(name)
    where = f"preset {name} ({preset.source})"
    for block, keys in preset.fixed.items():
        for key, value in keys.items():
            seen = getattr(getattr(config, block), key)
            if seen != value:
                raise ConfigError(f"{where} has [{block}] {key} = {value}, found {seen}")
    if source != "camera":
        raise ConfigError(f"{where} takes the terrain from the camera (a model), found {source!r}")
    if model is None or model.preset != preset.model_preset or model.colour_:
        raise ConfigError(
            f"{where} needs a model of train --preset {preset.model_preset}, without colour; found "
            + ("none" if model is None else f"one of {model.preset!r}, colour {model.colour_}")
        )
    if parameters.terrains:
        raise ConfigError(
            f"{where} knows no parameter sets: on another terrain it goes on from the ICRs that it "
            f"has; found one of {', '.join(parameters.terrains)}"
        )
    return _with_look_ahead(config, run), OnePatchClassifier(model)


def _with_look_ahead(config: Config, run: Run) -> Config:
    """Settings with one look-ahead time t_s for all images, as in the paper (3.2.2).

    The paper does not print its t_s. Unless [region] ahead_s gives one, it is the smallest after
    which the image holds the whole region of a robot that drives straight on at the median speed
    of the run.
    """
    if config.region.ahead_s > 0 or "camera" not in run.settings:
        return config
    if config.filter.causal:
        raise ConfigError(
            "[filter] causal knows no median speed of the run; give [region] ahead_s, the "
            "look-ahead time t_s"
        )
    camera = Camera.from_table(run.settings["camera"], str(run.folder / "run.toml"))
    speeds_m_s = np.abs(run.odometry.stack("v_left", "v_right")).mean(axis=1)
    speed_m_s = float(np.nanmedian(speeds_m_s[speeds_m_s > 0])) if np.any(speeds_m_s > 0) else 0.0
    whole = replace(config.region, least_share=1.0)
    region = predict_region(run.robot, camera, speed_m_s * STRAIGHT, speed_m_s, whole)
    if isinstance(region, NoRegion):
        raise ConfigError(
            f"no look-ahead time t_s fits the camera: {region.reason}; give [region] ahead_s"
        )
    return replace(config, region=replace(config.region, ahead_s=region.ahead_s))
