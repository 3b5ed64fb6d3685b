"""How sure a parameter set is of its numbers: `sigma` and `covariance` of one table."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError

LARGEST = 1e9  # of a parameter in SI units: the stiffest and heaviest stay below


def finite_number(value: Any, where: str) -> float:
    """The value as a float, or a ParameterError that names its place."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= LARGEST:
        raise ParameterError(
            f"{where} = {value!r}, expected a finite number, at most {LARGEST:g} in size"
        )
    return float(value)


def covariance_of_table(
    table: Mapping[str, Any], names: tuple[str, ...], where: str
) -> tuple[tuple[str, ...], FloatArray]:
    """Names (K) and covariance (K, K) that `sigma` or `covariance` of a table states.

    Parameters
    ----------
    table : Mapping
        One `[terrain.NAME]`.
    names : names of the parameters that its model has
    where : str
        For messages.

    Raises
    ------
    ParameterError
        If it is stated twice, of something else, or is no covariance.
    """
    if "sigma" in table and "covariance" in table:
        raise ParameterError(f"{where}: both sigma and covariance; expected one of them")
    if "covariance" in table:
        order, matrix = _order_and_matrix(table["covariance"], where)
    else:
        sigma = table.get("sigma", {})
        if not isinstance(sigma, dict):
            raise ParameterError(f"{where}: sigma = {sigma!r}, expected a table")
        order = tuple(sigma)
        deviations = [finite_number(value, f"{where}: sigma.{key}") for key, value in sigma.items()]
        if any(deviation < 0 for deviation in deviations):
            raise ParameterError(f"{where}: sigma = {sigma}, expected none below zero")
        matrix = np.diag(np.square(deviations)) if order else np.empty((0, 0))
    for name in order:
        if name not in names:
            raise ParameterError(f"{where}: uncertainty of {name!r}, which is no parameter")
    if matrix.shape != (len(order), len(order)):
        raise ParameterError(
            f"{where}: covariance of shape {matrix.shape} for {len(order)} parameters"
        )
    if order and not _is_covariance(matrix):
        raise ParameterError(
            f"{where}: the covariance is not symmetric, finite and positive semi-definite"
        )
    return order, matrix


def _order_and_matrix(table: Any, where: str) -> tuple[tuple[str, ...], FloatArray]:
    match table:
        case {"order": [*order], "matrix": [*rows]} if len(set(map(str, order))) == len(order) > 0:
            try:
                return tuple(order), np.array(rows, dtype=np.float64)
            except (TypeError, ValueError):
                raise ParameterError(f"{where}: covariance.matrix = {rows}, not numbers") from None
    raise ParameterError(
        f"{where}: covariance = {table!r}, expected order = [names, each once], matrix = [[...]]"
    )


def _is_covariance(matrix: FloatArray) -> bool:
    if not np.all(np.abs(matrix) <= LARGEST**2) or not np.allclose(
        matrix, matrix.T, rtol=1e-9, atol=0
    ):
        return False
    eigenvalues = np.linalg.eigvalsh(matrix)
    return bool(eigenvalues[0] >= -1e-12 * max(eigenvalues[-1], 1e-300))
