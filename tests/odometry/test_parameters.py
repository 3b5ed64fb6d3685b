import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from odometry.errors import ParameterError
from odometry.models.catalogue import MODELS
from odometry.parameters import ParameterSet, TerrainParameters, read_parameters, write_parameters

CONVENTIONS_EXAMPLE = """
[vehicle]
name = "a robot"
wheels = 4
[terrain.asphalt]
model = "icr"
y_left = 0.41
y_right = -0.39
x_icr = -0.02
source = "identified from ..."
[terrain.asphalt.sigma]
y_left = 0.02
[[terrain.asphalt.effects]]
name = "slope_sliding"
form = "icr_slope"
parameters = { lambda_1 = 1.2, lambda_2 = 5.0, v_max = 1.0, half_width = 0.6, half_length = 1.06 }
[terrain."wet grass"]
y_left = 1
y_right = -1
x_icr = 0
alpha_left = 0.9
[terrain."wet grass".covariance]
order = ["x_icr", "y_left"]
matrix = [[0.04, 0.01], [0.01, 0.09]]
"""

ICR = "y_left = 1\ny_right = -1\nx_icr = 0\n"


@pytest.fixture
def read(tmp_path):
    def read_text(text):
        file = tmp_path / "set.toml"
        file.write_text(text)
        return read_parameters(file)

    return read_text


def test_the_example_of_the_conventions(read):
    parameters = read(CONVENTIONS_EXAMPLE)
    assert list(parameters.terrains) == ["asphalt", "wet grass"]
    assert parameters.vehicle == {"name": "a robot", "wheels": 4}
    asphalt = parameters.terrains["asphalt"]
    assert asphalt.model == "icr"
    assert asphalt.values == {"y_left": 0.41, "y_right": -0.39, "x_icr": -0.02}
    assert asphalt.source == "identified from ..."
    assert asphalt.effects[0]["parameters"]["lambda_2"] == 5.0
    np.testing.assert_allclose(asphalt.covariance_of(("y_left",)), [[0.0004]])
    assert asphalt.covariance_order == ("y_left",)


def test_model_is_icr_and_slip_factors_are_one_when_absent(read):
    grass = read(CONVENTIONS_EXAMPLE).terrains["wet grass"]
    assert grass.model == "icr"
    np.testing.assert_array_equal(MODELS["icr"].pack(grass.values), [1, -1, 0, 0.9, 1])


def test_a_covariance_is_found_by_name(read):
    grass = read(CONVENTIONS_EXAMPLE).terrains["wet grass"]
    np.testing.assert_array_equal(
        grass.covariance_of(("y_left", "x_icr")), [[0.09, 0.01], [0.01, 0.04]]
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[terrain", ["TOML"]),
        ("", ["[terrain.NAME]"]),
        ("[terrain]\n", ["[terrain.NAME]"]),
        ("terrain = 3\n", ["[terrain.NAME]"]),
        ("[terain.a]\n" + ICR, ["terain"]),
        ("vehicle = 3\n[terrain.a]\n" + ICR, ["vehicle", "3"]),
        ("[terrain.unknown]\n" + ICR, ["unknown", "reserved"]),
        ("[terrain]\na = 3\n", ["terrain.a", "3"]),
        ("[terrain.a]\nmodel = 'ackermann'\n", ["terrain.a", "ackermann", "icr_slope"]),
        ("[terrain.a]\nmodel = 3\n", ["terrain.a", "3"]),
        ("[terrain.a]\nmodel = ['icr']\n", ["terrain.a", "icr"]),
        ("[terrain.a]\nylef = 1\n" + ICR, ["terrain.a", "ylef", "y_left"]),
        ("[terrain.a]\ny_left = 1\nx_icr = 0\n", ["terrain.a", "y_right"]),
        ("[terrain.a]\ny_left = nan\ny_right = -1\nx_icr = 0\n", ["terrain.a", "y_left", "nan"]),
        ("[terrain.a]\ny_left = 1\ny_right = -1\nx_icr = inf\n", ["terrain.a", "x_icr", "inf"]),
        ("[terrain.a]\ny_left = 1e300\ny_right = -1\nx_icr = 0\n", ["y_left", "1e+300", "1e+09"]),
        ("[terrain.a]\n" + ICR + "sigma = { y_left = 1e300 }\n", ["sigma.y_left", "1e+300"]),
        ("[terrain.a]\n" + ICR + f"h = {'1' * 6000}\n", ["cannot be read as TOML", "digits"]),
        ("[terrain.a]\ny_left = '1'\ny_right = -1\nx_icr = 0\n", ["terrain.a", "y_left", "'1'"]),
        ("[terrain.a]\ny_left = true\ny_right = -1\nx_icr = 0\n", ["y_left", "True"]),
        ("[terrain.a]\ny_left = -1\ny_right = 1\nx_icr = 0\n", ["terrain.a", "y_left > y_right"]),
        ("[terrain.a]\nalpha_left = -1\n" + ICR, ["terrain.a", "alpha_left", "-1"]),
        ("[terrain.a]\nmodel = 'icr_symmetric'\nalpha = 1\nb_hat = 0\n", ["terrain.a", "b_hat"]),
        ("[terrain.a]\nsigma = 3\n" + ICR, ["terrain.a", "sigma", "3"]),
        ("[terrain.a]\n" + ICR + "sigma = { y_left = -1 }\n", ["terrain.a", "sigma", "-1"]),
        ("[terrain.a]\n" + ICR + "sigma = { width = 1 }\n", ["terrain.a", "width"]),
        ("[terrain.a]\n" + ICR + "sigma = { y_left = 'a' }\n", ["terrain.a", "sigma.y_left"]),
        ("[terrain.a]\ncovariance = 3\n" + ICR, ["terrain.a", "covariance", "order"]),
        ("[terrain.a]\n" + ICR + "covariance = { matrix = [[1]] }\n", ["covariance", "order"]),
        (
            "[terrain.a]\n" + ICR + "covariance = { order = ['y_left', 'y_left'], "
            "matrix = [[1, 0], [0, 1]] }\n",
            ["covariance", "once"],
        ),
        (
            "[terrain.a]\n" + ICR + "covariance = { order = ['y_left'], matrix = [['a']] }\n",
            ["covariance", "not numbers"],
        ),
        (
            "[terrain.a]\n" + ICR + "covariance = { order = ['y_left', 'x_icr'], "
            "matrix = [[1, 0], [0]] }\n",
            ["covariance", "not numbers"],
        ),
        (
            "[terrain.a]\n" + ICR + "covariance = { order = ['y_left'], matrix = [[1, 2]] }\n",
            ["covariance", "(1, 2)"],
        ),
        (
            "[terrain.a]\n" + ICR + "covariance = { order = ['y_left', 'x_icr'], "
            "matrix = [[1, 2], [2, 1]] }\n",
            ["positive semi-definite"],
        ),
        (
            "[terrain.a]\n" + ICR + "covariance = { order = ['y_left', 'x_icr'], "
            "matrix = [[1, 0.1], [0.2, 1]] }\n",
            ["symmetric"],
        ),
        (
            "[terrain.a]\n" + ICR + "covariance = { order = ['y_left'], matrix = [[1]] }\n"
            "sigma = { y_left = 1 }\n",
            ["both sigma and covariance"],
        ),
        ("[terrain.a]\neffects = 3\n" + ICR, ["terrain.a", "effects", "3"]),
        ("[terrain.a]\neffects = [3]\n" + ICR, ["terrain.a", "effects", "3"]),
    ],
)
def test_what_is_wrong_is_named(read, text, words):
    with pytest.raises(ParameterError) as error:
        read(text)
    for word in ("set.toml", *words):
        assert word in str(error.value)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ParameterError, match=r"gone\.toml"):
        read_parameters(tmp_path / "gone.toml")


number = st.floats(-1e6, 1e6)
name = st.text(min_size=1, max_size=8).filter(lambda text: text != "unknown")
text = st.text(max_size=8)


@st.composite
def icr_tables(draw):
    y_right, x_icr = draw(number), draw(number)
    values = {"y_left": y_right + draw(st.floats(0.1, 9)), "y_right": y_right, "x_icr": x_icr}
    order = tuple(draw(st.lists(st.sampled_from(list(values)), unique=True)))
    root = np.array(draw(st.lists(st.floats(-3, 3), min_size=9, max_size=9))).reshape(3, 3)
    covariance = (root @ root.T)[: len(order), : len(order)] if order else np.empty((0, 0))
    effects = tuple(draw(st.lists(st.fixed_dictionaries({"name": text, "by": number}), max_size=2)))
    return TerrainParameters("icr", values, order, covariance, draw(text), effects)


@settings(max_examples=40)
@given(st.dictionaries(name, icr_tables(), min_size=1, max_size=3), st.dictionaries(name, text))
def test_what_is_written_reads_back(tmp_path_factory, terrains, vehicle):
    file = tmp_path_factory.getbasetemp() / "round_trip.toml"
    write_parameters(file, ParameterSet(terrains, vehicle))
    read = read_parameters(file)
    assert (list(read.terrains), read.vehicle) == (list(terrains), vehicle)
    for name, table in terrains.items():
        again = read.terrains[name]
        assert (again.model, again.values, again.source) == (
            table.model,
            table.values,
            table.source,
        )
        assert again.covariance_order == table.covariance_order
        assert again.effects == table.effects
        np.testing.assert_array_equal(again.covariance, table.covariance)


def test_a_set_of_skid_modes_is_no_parameter_set(tmp_path):
    file = tmp_path / "modes.toml"
    file.write_text('[modes]\nkind = "velocity"\n[mode.grass]\ndwell_s = 20\n')
    with pytest.raises(ParameterError, match=r"set of skid modes.*\[terrain\.NAME\]"):
        read_parameters(file)
