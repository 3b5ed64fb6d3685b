"""Names that do not have the form of what they stand for, and functions that do hardly better."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.corrected import Added
from odometry.effects.slope_contact import SlopeByContact
from odometry.gap.config import GapConfig
from odometry.gap.contest import Judged
from odometry.gap.evenness import Unevenness
from odometry.gap.explanation import Explanation
from odometry.gap.form import of_their_form


@pytest.mark.parametrize(("mu", "stands"), [(0.6, True), (2.0, False)])
def test_what_other_effects_have_bent_is_asked_again(monkeypatch, mu, stands):
    """Contacts were a robot when they were named, and are none beside what was added since."""
    monkeypatch.setattr("odometry.gap.form.smooth_in_place", lambda *_: None)
    monkeypatch.setattr("odometry.gap.form.unevenness", lambda *_: Unevenness(0.0, 1.0))
    effect, refused = SlopeByContact(), []
    fitted = SimpleNamespace(effects=(Added(effect, np.array([mu, 0.2, 0.3, 0.0, 0.03])),))
    found = Explanation(None, (Judged(effect, fitted, 90.0, 80.0, 70.0, 0.1),), ())
    search = SimpleNamespace(
        fitter=None, config=GapConfig(), refuse=lambda *reason: refused.append(reason)
    )
    assert bool(of_their_form(search, found, ()).steps) == stands
    assert bool(refused) != stands
