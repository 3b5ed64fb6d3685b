from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added, corrected_twist
from odometry.effects.interface.recorded import Recorded, labels_of
from odometry.effects.motion.curvature import Curvature
from odometry.effects.motion.terrain import NewIcrs, Terrain
from odometry.errors import ParameterError
from odometry.models.catalogue import MODELS
from odometry.models.icr import IcrByTerrain, icr_twist
from odometry.models.inputs import Inputs

EFFECT = Added(
    Terrain(("ice", "mud")), np.array([0.2, -0.1, 0.05, -0.1, 0.02, 0.3, 0.0, 0.0, 0.0, 0.0])
)


def test_each_terrain_has_its_own_icrs(bench, rng):
    inputs = bench.drive(rng)
    found = corrected_twist(bench.base, [EFFECT], inputs)
    speeds, icrs, alphas = inputs.tread_speeds_m_s, bench.values[:3], bench.values[3:]
    on_ice = inputs.terrain == "ice"
    assert 0 < on_ice.sum() < len(on_ice)
    expected = np.where(
        on_ice[:, None],
        icr_twist(icrs + np.array([0.2, -0.1, 0.05]), (alphas + np.array([-0.1, 0.02])) * speeds),
        icr_twist(icrs, alphas * speeds),
    )
    np.testing.assert_allclose(found, expected, atol=1e-14)


def test_its_parameters_are_named_after_the_terrains():
    names = [parameter.name for parameter in EFFECT.effect.parameters]
    shifted = ("y_left", "y_right", "x_icr", "alpha_left", "alpha_right")
    assert names == [f"{name}_{g}" for g in ("ice", "mud") for name in shifted]


def test_new_terrains_are_offered_together_and_known_ones_each(bench, rng):
    """A terrain of the calibration may have changed since."""
    recorded = Recorded(bench.base, (bench.drive(rng),), ((1.0, 4.0),), frozenset({"sand"}))
    assert [effect.labels for effect in Terrain.offered(recorded)] == [("ice",), ("sand",)]
    nowhere = Recorded(bench.base, (bench.drive(rng),), ((1.0, 4.0),))
    assert [effect.labels for effect in Terrain.offered(nowhere)] == [("ice", "sand")]


def test_the_one_terrain_of_all_runs_is_a_set_for_whole_runs(bench, rng):
    """Its ICRs by label would be those of `NewIcrs`; of one that is new the label says more."""
    drive = bench.drive(rng)
    on_ice = replace(drive, terrain=np.full(len(drive.terrain), "ice", dtype=object))
    whole = Recorded(bench.base, (on_ice,), ((1.0, 4.0),), frozenset({"ice"}))
    assert Terrain.offered(whole) == ()
    assert [effect.form for effect in NewIcrs.offered(whole)] == ["icr_set"]
    new = Recorded(bench.base, (on_ice,), ((1.0, 4.0),), frozenset({"sand"}))
    assert [effect.labels for effect in Terrain.offered(new)] == [("ice",)]
    partly = replace(on_ice, terrain=np.where(np.arange(len(drive.terrain)) < 9, "", "ice"))
    for inputs in ((on_ice, partly), (on_ice, replace(drive, terrain=None))):
        some = Recorded(bench.base, inputs, ((1.0, 4.0),), frozenset({"ice"}))
        assert [effect.labels for effect in Terrain.offered(some)] == [("ice",)]


def test_labels_that_name_no_terrain_are_none():
    inputs = Inputs(np.zeros((3, 2)), terrain=np.array(["unknown", "", "mud"]))
    assert labels_of(inputs) == {"mud"}
    assert labels_of(Inputs(np.zeros(2))) == set()


def test_a_set_for_whole_runs_shifts_every_sample(bench, rng):
    inputs, shift = bench.drive(rng), np.array([0.2, -0.1, 0.05, -0.1, 0.02])
    found = corrected_twist(bench.base, [Added(NewIcrs(), shift)], inputs)
    moved = bench.values + shift
    expected = icr_twist(moved[:3], moved[3:] * inputs.tread_speeds_m_s)
    np.testing.assert_allclose(found, expected, atol=1e-14)


def test_what_it_lacks(bench, rng):
    inputs = bench.drive(rng)
    assert EFFECT.effect.lacks(inputs, bench.base) == ""
    assert "labels" in Terrain().lacks(inputs, bench.base)
    other = Base(MODELS["icr_symmetric"], np.array([1.0, 0.8]), bench.robot)
    assert "tread ICRs" in EFFECT.effect.lacks(inputs, other)
    with pytest.raises(ParameterError, match=r"'terrain' moves tread ICRs.*'icr_symmetric'"):
        corrected_twist(other, [EFFECT], inputs)


@pytest.mark.parametrize("labels", ["ice", (3,)])
def test_labels_are_a_list_of_names(labels):
    with pytest.raises(ParameterError, match="expected a list of names"):
        Terrain(labels)


def test_beside_icrs_by_terrain_each_effect_sees_those_of_the_sample(bench, rng):
    """A base with ICRs for sand and ice moves on each as one of these ICRs alone."""
    inputs = bench.drive(rng)
    on_ice = bench.values + np.array([0.3, -0.3, 0.02, -0.2, -0.1])
    model = IcrByTerrain(("sand", "ice"))
    base = Base(model, np.concatenate([bench.values, on_ice]), bench.robot)
    curved = Added(Curvature(), np.array([1.2, 0.4, 0.7]))
    for effects in ([EFFECT], [curved, EFFECT]):
        found = corrected_twist(base, effects, inputs)
        for label, values in (("sand", bench.values), ("ice", on_ice)):
            plain = corrected_twist(Base(MODELS["icr"], values, bench.robot), effects, inputs)
            here = inputs.terrain == label
            assert here.any()
            np.testing.assert_array_equal(found[here], plain[here])


def test_no_terrain_turns_a_robot_against_its_treads():
    """Columns that are exchanged have a set of ICRs that does: left ones on the right."""
    swapped, narrow = np.array([-1.0, 1.0, 0, 0, 0]), np.array([-0.4, 0.4, 0, 0, 0])
    for effect in (NewIcrs(0.9), Terrain(("sand",), 0.9)):
        assert effect.is_meant(narrow)
        assert not effect.is_meant(swapped)
    two = Terrain(("ice", "sand"), 0.9)
    assert two.is_meant(np.append(narrow, narrow))
    assert not two.is_meant(np.append(narrow, swapped))
    assert NewIcrs().is_meant(swapped)
