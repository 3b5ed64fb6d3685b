"""The run over gravel, boards and gravel, labelled by spans of time."""

import pytest

from odometry.recording.run import Run
from terrain.labelling.given_terrain import TerrainSpan, given_by_spans
from terrain.labelling.label_runs import label_runs
from terrain.labelling.scale import LabelConfig

SMALL = LabelConfig(place_m=1.0)


@pytest.fixture(scope="session")
def told_spans(world):
    """Spans of a run over the world's three stretches; those of the robot's middle are exact."""
    ends_s = [0.0, *(edge / world.speed_m_s for edge in world.edges_m), 60.0]
    names = ("gravel", "boards", "gravel")
    spans = [TerrainSpan(*ends_s[k : k + 2], name) for k, name in enumerate(names)]
    return lambda run: given_by_spans(run, spans, 0.0)


@pytest.fixture(scope="session")
def labelled(across_run, told_spans):
    """Its labelled ground; not to be changed."""
    run = Run.read(across_run)
    return label_runs([run], [told_spans(run)], SMALL)
