"""Values and inputs drawn for every kinematic model, about the ordinary ones of its row."""

import numpy as np
from hypothesis import strategies as st

from odometry.models.inputs import Inputs
from tests.contracts.test_models import CONVENTIONS, ordinary

G = 9.80665

speed = st.floats(-2, 2)
tread_speeds = st.one_of(
    st.tuples(speed, speed), speed.map(lambda v: (v, v)), speed.map(lambda v: (v, -v))
).map(np.array)
small = st.floats(-0.4, 0.4)
draws = st.lists(st.floats(-1, 1), min_size=12, max_size=12)


@st.composite
def inputs_(draw):
    roll, pitch = draw(small), draw(small)
    level = G * np.array([-np.sin(pitch), np.cos(pitch) * np.sin(roll)])
    driven = np.array([draw(st.floats(-3, 3)), draw(st.floats(-3, 3))])
    return Inputs(draw(tread_speeds), np.array(roll), np.array(pitch), level + driven)


def spreads(model):
    return np.array([spread for _, _, spread in CONVENTIONS[model.name].values()])


def values_of(model, drawn):
    middle = np.array(list(ordinary(model).values()))
    return middle + np.array(drawn)[: len(middle)] * spreads(model)
