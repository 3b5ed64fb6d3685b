"""Options of a replay, beside the run itself."""

from dataclasses import dataclass, field, replace
from pathlib import Path

from odometry.checks.findings.finding import CheckReport
from odometry.recording.run import Run
from odometry.recording.run_span import Span
from terrain.believed import believed, without_wrong_velocity
from terrain.config import Config
from terrain.main_job import run_odometry
from terrain.result.run_result import RunResult
from terrain.sources.sources import source_name

FILES = ("model", "parameters", "modes", "feel")


@dataclass(frozen=True)
class RunOptions:
    """The options of `run`, for one run or for many.

    Attributes
    ----------
    config : Config
    model, parameters, modes, feel : Path or None
        Files, see `run_odometry`.
    vision : bool
    terrain : str or None
    source : str or None
    preset : str or None
    span : Span
        What of each run is replayed.
    """

    config: Config
    model: Path | None = None
    parameters: Path | None = None
    modes: Path | None = None
    feel: Path | None = None
    vision: bool = True
    terrain: str | None = None
    source: str | None = None
    preset: str | None = None
    span: Span = field(default_factory=Span)

    @property
    def terrain_source(self) -> str:
        """Name of the source of the terrain."""
        return source_name(
            self.source,
            vision=self.vision,
            has_model=self.model is not None,
            has_feel=self.feel is not None,
        )

    @property
    def reads_images(self) -> bool:
        """Whether images of the runs are opened."""
        return self.terrain_source == "camera"

    @property
    def wants_images(self) -> bool:
        """Whether they are opened, or would be if there were a model."""
        return self.reads_images or (self.source is None and self.vision)

    @property
    def files(self) -> tuple[Path, ...]:
        """What has to be there beside the runs."""
        return tuple(file for file in (self.model, self.parameters, self.modes, self.feel) if file)

    def absolute(self) -> "RunOptions":
        """The same for a process that works in another folder."""
        files = {name: getattr(self, name) for name in FILES}
        return replace(self, **{name: file and file.absolute() for name, file in files.items()})

    def believed(self, run: Run, report: CheckReport) -> "tuple[Run, RunOptions, str]":
        """A run and options, without what the check of the run contradicts.

        Without velocity.csv where it is wrong, without vision where images show other terrain, and
        beside the parts of them that show the robot itself. A published system (a preset) is what
        it is, and keeps its camera.

        Returns
        -------
        Run
        RunOptions
        str
            Why velocities or vision are left out, or "".
        """
        if self.preset is not None:
            return run, self, ""
        run, said = without_wrong_velocity(run, report)
        run, cause = believed(run, report) if self.reads_images else (run, "")
        if not cause:
            return run, self, said
        source = None if self.source == "camera" else self.source
        vision = f"vision is left out, as with --no-vision: {cause}"
        said = "; ".join(filter(None, (said, vision)))
        return run, replace(self, vision=False, source=source), said

    def replay(self, run: Run, *, show_progress: bool = False) -> RunResult:
        """Replay a run with these options.

        Raises
        ------
        OdometryError
            As `run_odometry`.
        """
        return run_odometry(
            run,
            model=self.model,
            parameters=self.parameters,
            vision=self.vision,
            terrain=self.terrain,
            config=self.config,
            source=self.terrain_source,
            modes=self.modes,
            feel=self.feel,
            preset=self.preset,
            show_progress=show_progress,
        )
