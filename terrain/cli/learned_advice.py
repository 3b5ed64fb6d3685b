"""Whether the next run should start from what this one has learned."""

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from terrain.run_result import RunResult


def learned_advice(
    result: "RunResult", run_folder: Path, out: Path, *, has_warnings: bool, preset: str | None
) -> str | None:
    """One line on learned.toml; None where the run has learned nothing, or a preset refuses it.

    Parameters
    ----------
    result : RunResult
    run_folder, out : Path
        Of the run, and of its results.
    has_warnings : bool
        Whether the check of the recording found what would mislead.
    preset : str, optional
        A published system knows no parameter sets.
    """
    from terrain.filter_summary import misleading

    if preset is not None or not result.has_learned:
        return None
    if has_warnings:
        return (
            "learned.toml is not recommended: the recording has warnings (terrain-odometry check "
            f"{run_folder})"
        )
    events = misleading(result.replay)
    if events:
        kinds = ", ".join(dict.fromkeys(event.kind.replace("_", " ") for event in events))
        return (
            f"learned.toml is not recommended: the filter noticed {kinds} (see {out}/report.html)"
        )
    return f"Next time: --parameters {out / 'learned.toml'} starts from what was learned"
