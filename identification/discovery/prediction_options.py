"""Judgement constants of a discovery over a horizon, with their units and reasons."""

from __future__ import annotations

from dataclasses import dataclass

from identification.kalman.options import KalmanOptions, option


@dataclass(frozen=True, kw_only=True)
class PredictionOptions(KalmanOptions):
    """Options of what is tried and told where predictions of unseen records decide.

    Every field has its unit, reason and source in its metadata (`dataclasses.fields`).

    Raises:
        InputError: a value is no number, or lies outside the range that makes sense.
    """

    max_horizon_effects: int = option(
        3, "effects",
        "Over a horizon: largest number of effects that are named; each further one costs minutes"
        " of an arm, all places of which are refitted.",
        "judgement", least=1,
    )  # fmt: skip
    max_begun: int = option(
        6, "candidates",
        "Over a horizon: largest number of candidates that are fitted to some of the windows in a"
        " round; the best `max_refits` of them, and those near them, are refitted to all.",
        "judgement", least=1,
    )  # fmt: skip
    max_curves: int = option(
        3, "candidates",
        "Over a horizon: largest number of curves of the data that are fitted in a round, beside"
        " the laws: of speed, of position, and of one thing more.",
        "judgement", least=1,
    )  # fmt: skip
    drawn_share: float = option(
        0.5, "of a fall of the mean square",
        "Over a horizon: a law at whose joint a curve was found later is named where it still"
        " explains more than this share of what it explained alone.",
        "judgement", most=1.0,
    )  # fmt: skip
    max_output_ratio: float = option(
        1.5, "times its noise",
        "Over a horizon: an output whose error is larger has something left, whatever the others"
        " do; its noise, which its own differences tell, is known to a tenth or two.",
        "judgement", least=1.0,
    )  # fmt: skip
    max_scored: int = option(
        300, "candidates",
        "Over a horizon: more of them, which robots of several joints have, are scored on some of"
        " the windows first, and those that are promising there on all of them.",
        "judgement: a minute of one core",
    )  # fmt: skip
    max_scored_shapes: int = option(
        2, "shapes",
        "Over a horizon: of an effect at a place, largest number of shapes that are then scored on"
        " all windows.",
        "judgement", least=1,
    )  # fmt: skip
    max_simpler: int = option(
        2, "candidates",
        "Over a horizon: largest number of laws with fewer numbers that are refitted beside the"
        " best one.",
        "judgement",
    )  # fmt: skip
    imitated_share: float = option(
        0.01, "of an effect's part in the outputs",
        "Over a horizon: an effect of which the free parameters leave less is one of them by"
        " another name, and no candidate.",
        "judgement", most=1.0,
    )  # fmt: skip
    strong_bic: float = option(
        10.0, "of BIC",
        "Over a horizon: a law with fewer numbers is taken instead of one whose criterion is better"
        " by less, where unseen records cannot tell them apart; and a candidate is refitted on all"
        " windows unless some of them tell by more that the few best ones are better.",
        "Kass and Raftery 1995: very strong evidence",
    )  # fmt: skip
    rival_share: float = option(
        0.5, "of what an effect explained",
        "Over a horizon: an effect that still explains more beside the named one is missing too,"
        " and no rival of it.",
        "judgement", most=1.0,
    )  # fmt: skip
    listed_confidence: float = option(
        0.02, "probability",
        "Over a horizon: a rival that is less likely is not listed.",
        "judgement", most=1.0,
    )  # fmt: skip
    different_ratio: float = option(
        2.0, "of the rms error of the other records",
        "Over a horizon: a record that is predicted worse than this, beyond chance, is told to be"
        " different.",
        "judgement", least=1.0,
    )  # fmt: skip
    max_input_error: float = option(
        0.05, "of the inputs' own rms",
        "Over a horizon: an error of prediction that inputs make which are off by no more, constant"
        " over each window, is no reason to say that something is missing; currents and commanded"
        " torques are seldom better.",
        "judgement",
    )  # fmt: skip
    told_clock_shift: float = option(
        0.1, "of the sampling time",
        "Over a horizon: a shift of a record's time stamps that is smaller than this, and not"
        " beyond chance among the records, is not told in the text; the JSON has it.",
        "judgement", most=1.0,
    )  # fmt: skip
    told_step_shift: float = option(
        1.0, "std",
        "Over a horizon: a value that a quarter of the model's step would move by more is told;"
        " less is within what its std tells.",
        "judgement",
    )  # fmt: skip
    told_step_error: float = option(
        0.9, "of the error of the fitted windows",
        "Over a horizon: if a quarter of the model's step would lower the error below this, it is"
        " told: a fifth of the mean square is then of the steps, and nothing that is missing.",
        "judgement", most=1.0,
    )  # fmt: skip
