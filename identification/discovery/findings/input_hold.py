"""Were the inputs held otherwise between their samples, would a model have less to explain?

Samples of a straight line taken for steps come half a sample late, which no effect of a robot is.
"""

from __future__ import annotations

from dataclasses import replace

from identification.discovery.fitted_model import FittedModel
from identification.errors import DivergenceError
from identification.kalman.point import evaluate_point
from identification.kalman.refit import estimate_noise
from identification.quantities import alike

LEFT = 0.5  # of the inputs' error, below which the other hold is the likelier one
IN_WORDS = {"foh": "run in straight lines between their samples", "zoh": "hold until the next"}


def find_input_hold(nominal: FittedModel) -> tuple[str, ...]:
    """A sentence where inputs held otherwise would have to err far less.

    Args:
        nominal: the fitted model without effects.
    """
    fit, point = nominal.refit, nominal.refit.point
    (other,) = {*IN_WORDS} - {point.log.hold}
    predictor = replace(point.predictor, log=replace(point.log, hold=other))
    try:
        there = evaluate_point(predictor, point.space, point.q, point.linear)
    except DivergenceError:
        return ()
    level = estimate_noise(there, fit.prior, fit.level)
    if level.input_std >= LEFT * fit.level.input_std:
        return ()
    unit = point.log.units.get(point.log.input_names[0], "")
    then, now = alike([level.input_std, fit.level.input_std], unit)
    return (
        f"if its inputs {IN_WORDS[other]}, they would have to err by {then} rms and not by {now}:"
        f' is it not hold = "{other}" in the log\'s TOML?',
    )
