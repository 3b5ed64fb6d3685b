"""Drives of which no parameters can be identified."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.errors import IdentificationError, OdometryError
from odometry.identification.identify import identify
from tests.odometry.checks.drives import drive, winding

AT_S = 0.05 * np.arange(1600)
STILL = 0 * AT_S
ALONE = {
    "only goes straight on": drive(1 + 0.3 * np.sin(AT_S / 7), STILL),
    "only spins on the spot": drive(STILL, 0.6 * np.sign(np.sin(AT_S / 9))),
    "drives circles of one radius": drive(1 + STILL, 0.5 + STILL),
    "hardly drives": drive(0.5 * (AT_S < 2), 0.3 * (AT_S < 2)),
}


def noted(run):
    return [one for one in check_recording(run).findings if one.name == "one_motion"]


@pytest.mark.parametrize("motion", ALONE)
def test_a_drive_of_one_motion_is_noted_and_identify_refuses_it(motion):
    (found,) = noted(ALONE[motion])
    assert (found.level, found.cause.startswith(f"By the treads the robot {motion}: ")) == (
        Level.NOTE,
        True,
    )
    with pytest.raises(OdometryError) as refusal:
        identify([ALONE[motion]], "icr", show_progress=False).require_determined()
    assert isinstance(refusal.value, IdentificationError) or "no window" in str(refusal.value)


def test_turns_of_several_radii_are_not_noted():
    run = winding()
    assert noted(run) == []
    identify([run], "icr", show_progress=False).require_determined()


def test_without_poses_there_is_nothing_to_identify():
    assert noted(replace(ALONE["only goes straight on"], pose=None)) == []
