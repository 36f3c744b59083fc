"""Would the model have less to explain if the inputs were held otherwise between their samples?

An input that runs in straight lines and is taken for steps comes half a sample late; that looks
like an error of the inputs, and no effect of a robot.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from identification.discovery.attempts import attempt
from identification.discovery.findings.evidence import InputHold
from identification.discovery.findings.finding import Finding, FindingKind
from identification.kalman.point import evaluate_point
from identification.kalman.problem import estimate_noise
from identification.kalman.refit import Refit

HOLDS = ("foh", "zoh")  # straight lines, steps
# Of the inputs' error: the other hold is reported where it leaves less than this.
OTHER_HOLD_SHARE = 0.5


def find_input_hold(fit: Refit) -> tuple[Finding, ...]:
    """Returns the other hold of the inputs if it makes their error far smaller; else nothing.

    Args:
        fit: the nominal model, fitted.
    """
    point = fit.point
    if not point.log.inputs.any():  # of a free swing, which no hold changes
        return ()
    other = HOLDS[1 - HOLDS.index(point.log.hold)]
    predictor = replace(point.predictor, log=replace(point.log, hold=other))
    evaluate = partial(evaluate_point, predictor, point.space, point.q, point, point.small)
    there = attempt(None, evaluate)
    if there is None:
        return ()
    level = estimate_noise(there, fit.priors, fit.level)
    if level.input_std >= OTHER_HOLD_SHARE * fit.level.input_std:
        return ()
    unit = point.log.units.get(point.log.input_names[0], "")
    evidence = InputHold(other, unit, level.input_std, fit.level.input_std)
    return (Finding(FindingKind.INPUT_HOLD, evidence),)
