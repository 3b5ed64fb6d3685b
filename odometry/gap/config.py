"""Settings of the gap workflow: every number by which it decides, and why it is as it is."""

from dataclasses import dataclass

from odometry.config import require, require_positive
from odometry.gap.smooth_config import SmoothConfig

POSITIVE = (
    *("horizon_s", "part_s", "least_evidence", "least_excess", "near_bound", "sure", "surely"),
    *("far_off", "equivalent_margin", "general_margin", "unexplained", "left_over"),
    *("contact_spread", "turns_above", "turns_times", "hardly", "uneven", "disagreeing"),
    "surely_disagreeing",
)
SHARES = (
    *("least_share", "least_rest", "first_share", "mostly_closed", "bursts_closed", "least_floor"),
    *("events_predicted", "least_held_out", "least_of_rest", "least_of_all", "most_without"),
    *("most_beaten", "least_better", "least_beside", "main_part", "one_sided", "no_farther"),
    *("much_farther", "largest_growth", "base_probability", "least_odds", "sure_odds", "still_off"),
)
AT_LEAST_TWO = dict.fromkeys(("folds", "held_back", "most_poses"), 2)
FEWEST = AT_LEAST_TWO | {"trimmed": 1, "most_effects": 1, "most_windows": 20}


@dataclass(frozen=True)
class GapConfig(SmoothConfig):
    """How a gap is measured, and when an effect is named; smooth functions by `SmoothConfig`.

    Attributes
    ----------
    horizon_s : float
        Duration of a window, over which the gap is an error of position; as near as stamps allow.
        Shorter where poses are chained in stretches into which it does not fit.
    least_covered : float
        Share of the most poses in windows that the chosen duration must keep.
    folds : int
        Parts of the measured runs; a candidate is evaluated on each by a fit to the others.
    least_floor : float
        Of the noise floor, as a share of the way of a window: exact data of a simulator without
        any effect show 0.0002 to 0.0007, by stamps, held speeds and slopes.
    part_s : float
        Length of the pieces that are dealt out to the folds, or held back.
    held_back : int
        Without runs to hold out, one piece of so many is held back.
    least_evidence : float
        That a name needs (twice the gain of log-likelihood, less the penalty), as a lower bound.
    trimmed : int
        Pieces of the runs without which a gain must still be one; or so many of them at least,
        each far off before, are brought within the noise floor.
    far_off : float
        In how many times its upper bound a piece is far off: noise never reaches that.
    least_share : float
        And must close this share of the excess that was there before any effect.
    least_rest : float
        A name after the first must close this share of what those before it leave of chi-squared
        above noise: what is imperfect in the form of one name is no other effect.
    first_share : float
        The first name must close this share of it: the main part of a gap is not small.
    least_excess : float
        Share of what noise leaves of chi-squared; a smaller excess is taken as this.
    sure, surely : float
        Standard deviations by which an effect must differ from one that does nothing; and where
        the interval of what makes it this effect spans none, as the others may do the same: 6 of
        a curvature in the place of a robot that turns less, more than 100 of true ones.
    near_bound : float
        In scales of a parameter: nearer to a bound than this it is at the bound.
    equivalent_margin : float
        Of evidence: less does not decide between two (a ratio of likelihoods of twenty).
    least_of_rival : float
        Share of what a name gains that another must gain to be as near: it is not compared else.
    general_margin : float
        Of evidence by which a smooth function must beat names to stand in their place.
    least_better : float
        And by this share of what the names close: a recording, sampled and averaged, follows no
        equation more exactly. True delays and lags lose by 0.0001 to 0.003, a delay in the place
        of a lag by 0.05.
    least_beside : float
        Share of what a name closes alone that it must still close beside a smooth function that
        beats it. Beside a function that does the same it closes 0.1 at most.
    main_part : float
        Share of what a smooth function closes in the place of a name that is a part of it, which
        the name must close to be its main part. True wheel scales closed 0.93 and more.
    largest_growth : float
        Share by which a wheel may seem larger from a moment on: twice what is left of a true one.
    one_sided : float
        Share of the change of the one side's wheels that the other side's may have from a moment
        on: lost tyres have 0.05 at most, a battery that sags 0.95.
    no_farther, much_farther : float
        Shares by which positions may be farther off where headings or the gyroscope are judged:
        the first where they surely are, the second at all. True names moved positions that were
        within their noise by 0.05 at most.
    unexplained : float
        Chi-squared a degree of freedom above which what is left is not noise.
    left_over, mostly_closed, contact_closed, bursts_closed : float
        Chi-squared a degree of freedom that names may leave, unless they close this share of its
        excess. Beside a wrong name 1.8 to 190 is left and 0.75 closed at most. Forces of contacts,
        for which no equation here is exact, need to close less; events, whose begin and end are
        known to a quarter of a second, and what begins at a moment, more: on development seeds
        right ones close 0.96, wrong ones 0.88 at most.
    above_floor : float
        In how many times its uncertainty of 95 % the gap must be above the noise floor before
        anything is added, on held-out or on measured data (`Shown`). Of real recordings changed by
        hand, in windows where the held-out one was not, 4 of 7 names were wrong.
    turns_above, turns_times, hardly : float
        The same of headings and of the gyroscope, by which a gap is judged where positions are not
        above their floor, or by less than `hardly` times; and in how many times their floor these
        must be off, on held-out and on measured data. Of 33 simulated runs without an effect
        headings reach 1.2 times and a gyroscope 1.3 on both; of 31 real ones three are beyond, of
        which positions show two.
    least_held_out : float
        Share of the excess on held-out data that names must close, `least_of_rest` in bursts.
        Right ones close 0.22 (0.83) or more, traction in the place of slippery patches 0.05.
    least_of_rest : float
        Share of it that names must close where they leave more than `unexplained` (a drift in the
        place of a clock that was set closed 0.43), and poses that were left out to be its verdict.
        Names that are exact close `mostly_closed`: wheels of another size in the place of slip
        that grows after each stop closed 0.78, a loss of traction in that of a place 0.57.
    least_of_all : float
        Share of what names and smooth functions close together that names must close alone.
    most_without : float
        Share of what a name closes that it may close without its essential parameters.
    most_beaten : float
        Share of what a name closes by which a candidate that is refused may close more.
    events_predicted : float
        Area under the curve (ROC) with which a recorded variable may say when events are. True
        bursts have 0.72 at most, a drive that is limited on one side 0.97.
    by_place : float
        Probability of events at the same places by chance below which they are no bursts.
    event_nodes : tuple of int
        Of the grids of places, at most; patches that matter to treads are small.
    uneven, uneven_probability : float
        Spread of the strength of a name between pieces of the runs, as a share of it, above which
        it is no one strength; and the probability by chance below which that counts. Right names
        differ by 0.25 at most, a constant delay in the place of a clock that was set by 0.37.
    disagreeing, surely_disagreeing : float
        Difference between the strengths of a name that two measures show, as a share of it, above
        which it is no one strength; and the standard deviations that it must be. Right names
        differ by 0.27 and by 2.6 of these at most, smoothed poses in place of a bent yaw by 0.8.
    base_probability : float
        Of a base that moves as far within its calibration by chance: less is a base that left it.
    brought_back : float
        Share of the base's move that may be left where a name explains nothing but this move.
    contact_spread : float
        Chi-squared a degree of freedom that quick forms must leave before slow ones are fitted.
    gyro_least_of_yaw : float
        Least noise of the gyroscope's turn over a second, as a share of that of a measured yaw.
    beside : int
        Names that are tested beside a smooth function: those of most evidence without it.
    least_odds, sure_odds : float
        Odds at which a drive is proposed, and those at which no better drive is looked for.
    least_tilt_rad : float
        Steepest terrain measured, below which no drive on a slope is proposed: nobody could
        find it.
    most_effects : int
        Names at most.
    outlier_sigmas : float
        Standard deviations by which a single pose must be off its neighbours to be an outlier.
    least_outliers : int
        Of all measured runs, to be named.
    most_jumping : float
        Share of steps of a quarter of a second that may jump: more is another kind of noise.
    jumping_times : float
        As many jumps a step as in the calibration runs, at least: those with a fault show 4 and
        more where the others show none.
    outlier_probability, still_off : float
        With which the calibration runs may have as many by chance; and the share of its square
        that a jump adds at least to the gap beside names (a swaying mast adds a thirtieth).
    most_windows : int
        Where there are more, as many of them at even distances are used to fit.
    most_poses : int
        Of a window, after its first: 20 a second. The time that a fit takes grows with more than
        their number.
    """

    horizon_s: float = 2.0
    least_covered: float = 0.9
    least_floor: float = 1e-3
    folds: int = 5
    part_s: float = 10.0
    held_back: int = 4
    least_evidence: float = 12.0
    trimmed: int = 2
    far_off: float = 2.0
    least_share: float = 0.02
    least_rest: float = 0.3
    first_share: float = 0.1
    least_excess: float = 0.2
    sure: float = 3.0
    surely: float = 10.0
    near_bound: float = 0.1
    equivalent_margin: float = 6.0
    least_of_rival: float = 0.5
    general_margin: float = 6.0
    least_better: float = 0.005
    least_beside: float = 0.5
    main_part: float = 0.9
    one_sided: float = 0.5
    no_farther: float = 0.02
    much_farther: float = 0.1
    largest_growth: float = 0.02
    unexplained: float = 1.3
    left_over: float = 1.5
    mostly_closed: float = 0.8
    contact_closed: float = 0.4
    bursts_closed: float = 0.93
    above_floor: float = 1.0
    turns_above: float = 1.5
    turns_times: float = 1.5
    hardly: float = 1.5
    least_held_out: float = 0.1
    least_of_rest: float = 0.5
    least_of_all: float = 0.7
    most_without: float = 0.8
    most_beaten: float = 0.1
    events_predicted: float = 0.85
    by_place: float = 0.02
    event_nodes: tuple[int, ...] = (40, 80, 160)
    uneven: float = 0.3
    uneven_probability: float = 0.001
    disagreeing: float = 0.3
    surely_disagreeing: float = 4.0
    base_probability: float = 0.001
    brought_back: float = 0.25
    contact_spread: float = 1.1
    gyro_least_of_yaw: float = 1.0
    beside: int = 3
    least_odds: float = 0.6
    sure_odds: float = 0.98
    least_tilt_rad: float = 0.03
    most_effects: int = 3
    outlier_sigmas: float = 8.0
    least_outliers: int = 4
    most_jumping: float = 0.1
    jumping_times: float = 4.0
    outlier_probability: float = 0.001
    still_off: float = 0.25
    most_windows: int = 300
    most_poses: int = 40

    def __post_init__(self) -> None:
        super().__post_init__()
        require_positive(self, *POSITIVE)
        for name in SHARES:
            value = getattr(self, name)
            require(0 <= value < 1, f"{name} = {value}, expected 0 to 1")
        for name, least in FEWEST.items():
            count = getattr(self, name)
            require(count >= least, f"{name} = {count}, expected {least} or more")
