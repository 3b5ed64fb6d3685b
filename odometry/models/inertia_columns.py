"""Places of the parameters of the models with a force of inertia (`InertiaModel`), by name."""

from enum import IntEnum


class Column(IntEnum):
    """Place of a parameter; a derivative has the tread speeds after the parameters."""

    ZETA_0 = 0
    ZETA_1 = 1
    EPSILON_0 = 2
    EPSILON_1 = 3
    ETA_0 = 4
    ETA_1 = 5
    ETA_2 = 6
    H = 7
    MASS = 8
    X_CM = 9
    Y_CM = 10
    TRACK_WIDTH = 11
    V_LEFT = 12
    V_RIGHT = 13


COEFFICIENTS = slice(Column.ZETA_0, Column.H)
CENTRE_OF_MASS = slice(Column.X_CM, Column.TRACK_WIDTH)
PARAMETERS, SPEEDS = slice(0, Column.V_LEFT), slice(Column.V_LEFT, len(Column))
