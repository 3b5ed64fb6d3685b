"""Whether several names together are no one cause that has no name."""

from collections.abc import Sequence

import numpy as np

from odometry.effects.unknown.residual import Residual
from odometry.gap.fit.contest import cost_of
from odometry.gap.fit.fitter import Fitted
from odometry.gap.fit.input_noise import surely_dearer
from odometry.gap.locate.region_words import noun_of
from odometry.gap.name.search import Search


def is_more_than_one(search: Search, names: Fitted, smooth: Sequence[Residual]) -> str:
    """Why two names or more are one cause: a smooth function of one variable costs less than all.

    Freedom paid. Two true effects leave it more, as it follows one variable and has more numbers.
    Forces of contacts are right and imperfect: a function may cost less than they.
    """
    if len(names.effects) < 2 or any(added.effect.slow for added in names.effects):
        return ""
    fitter, config, start = search.fitter, search.config, search.fitter.fit([])
    losses = fitter.linear_losses(start, smooth)
    most = names.cost + config.beyond_first_order * (start.cost - names.cost)
    promising = np.argsort(losses, kind="stable")[: config.promising_in_place]
    for function in (smooth[i] for i in promising if losses[i] < most):
        alone = fitter.fit([function])
        if cost_of(alone) < cost_of(names) and surely_dearer(names, alone, fitter.measured) > 0:
            return (
                f"a smooth function of {noun_of(function.variable)} alone explains more than "
                f"{' and '.join(added.effect.name for added in names.effects)} together"
            )
    return ""
