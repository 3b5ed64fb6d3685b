"""A smooth function with the terms that earn their place."""

from dataclasses import replace

import numpy as np
from sklearn.linear_model import LassoLarsIC

from odometry.effects.unknown.residual import Residual
from odometry.gap.fit.fitter import Fitted, Fitter


def sparse_residual(fitter: Fitter, fit: Fitted) -> Residual:
    """The last effect of a fit, a `Residual`, with the terms that the lasso keeps by BIC.

    All other parameters are projected out, so that no term takes their place.
    """
    residual = fit.effects[-1].effect
    if not isinstance(residual, Residual):
        raise TypeError(f"the last effect is {residual.name}, expected a residual")
    design = fitter.design(fit)
    rows, jacobian = design.rows, design.jacobian
    own = jacobian[:, -len(residual.terms) :]
    others = jacobian[:, : -len(residual.terms)]
    target = own @ fit.effects[-1].values - rows
    basis, _ = np.linalg.qr(others)
    own, target = own - basis @ (basis.T @ own), target - basis @ (basis.T @ target)
    lengths = np.maximum(np.linalg.norm(own, axis=0), 1e-12)
    noise = max(1.0, float(rows @ rows) / len(rows))
    lasso = LassoLarsIC(criterion="bic", fit_intercept=False, noise_variance=noise)
    kept = lasso.fit(own / lengths, target).coef_ != 0
    if not kept.any():
        return residual
    terms = tuple(term for term, keep in zip(residual.terms, kept, strict=True) if keep)
    return replace(residual, terms=terms)
