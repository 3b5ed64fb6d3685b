"""Settings of a whole job, in blocks named after its steps."""

from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from odometry.config import block_from_table, read_toml
from odometry.errors import ConfigError
from odometry.estimation.config import IcrEkfConfig
from odometry.evaluation.relative import EvaluationConfig
from terrain.classification.config import ClassifierConfig
from terrain.region.region import RegionConfig
from terrain.switch.switch import SwitchConfig


@dataclass(frozen=True)
class Config:
    """Every setting of `run_odometry`; the defaults work with no file.

    Attributes
    ----------
    filter : IcrEkfConfig
    region : RegionConfig
    switch : SwitchConfig
    classifier : ClassifierConfig
    evaluation : EvaluationConfig

    Examples
    --------
    >>> import terrain
    >>> terrain.Config().evaluation.horizon_m
    5.0
    """

    filter: IcrEkfConfig = field(default_factory=IcrEkfConfig)
    region: RegionConfig = field(default_factory=RegionConfig)
    switch: SwitchConfig = field(default_factory=SwitchConfig)
    classifier: ClassifierConfig = field(default_factory=ClassifierConfig)
    evaluation: EvaluationConfig = field(default_factory=EvaluationConfig)

    @classmethod
    def read(cls, file: str | Path, base: "Config | None" = None) -> "Config":
        """Read `[filter]`, `[region]`, `[switch]`, `[classifier]`, `[evaluation]` of a TOML file.

        Parameters
        ----------
        file : path
        base : Config, optional
            What the file does not set; by default the default settings.

        Raises
        ------
        ConfigError
            Naming file, block and key.
        """
        content = read_toml(Path(file))
        kinds = {block.name: block.default_factory for block in fields(cls)}
        base = base or cls()
        blocks: dict[str, Any] = {}
        for name, table in content.items():
            if name not in kinds or not isinstance(table, dict):
                raise ConfigError(f"{file}: unknown block {name!r}; known: {', '.join(kinds)}")
            blocks[name] = block_from_table(
                kinds[name],  # type: ignore[arg-type]
                asdict(getattr(base, name)) | table,
                f"{file}: [{name}]",
            )
        return replace(base, **blocks)

    def to_table(self) -> dict[str, dict[str, Any]]:
        """All settings as plain values, for `result.json`."""
        return asdict(self)
