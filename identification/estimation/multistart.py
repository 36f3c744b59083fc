"""One search from several starting values, and the best result.

    q⁽⁰⁾ = q_start,   q⁽ⁱ⁾ uniform in q_start ± spread, inside the bounds
    trace    V(q) = Σ ρ(r²),                r: all of C W ε and (q - q̄)/s
    det      V(q) = n log det Λ + Σ ((q - q̄)/s)²,    Λ: covariance of W ε

If the criterion has local minima, different starts end in different places. If most starts end in
the same place, this is a reason to believe it. The best is the one with the smallest V, in which
each output counts by the noise of its unit: an angle and a way have no common rms. C weighs each
output by the noise of its unit, W by relative noise, q̄ ± s is what was known before. W is that of
the measured outputs, because a model that predicts too much may not lower its own weights, and q̄
is one for all searches.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.estimation.estimation import Estimate, Options, estimate
from identification.estimation.metrics import by_unit, relative, rms_by_unit
from identification.estimation.uncertainty import LOSSES
from identification.logs.log import Log
from identification.logs.noise import noise_floor, relative_weight, whitener_of
from identification.model.coordinates import Coordinates, coordinates
from identification.model.predictor import Plant
from identification.runtime.progress import Progress, counted

# Of the error to the noise floor: a search that ends below it is good enough.
ENOUGH_NOISE_RATIO = 1.5
LINEAR_SPREAD_SHARE = 0.1  # of the spread, for coordinates that are no logarithms, such as a pose


@dataclass(frozen=True)
class Starts:
    """Searches from several starts."""

    best: Estimate  # the search that explains the log best
    # the criterion V at which each search ended, in the order of the starts, shape (n,), without
    # unit; infinite where the search diverged. The best has the smallest.
    cost: np.ndarray
    # rms of the residual of each search over all outputs, shape (n,), in their unit; infinite where
    # the search diverged. Where outputs have several units it says little.
    rms: np.ndarray
    values: np.ndarray  # starting values, shape (n, p), in their units


def estimate_from(
    plant: Plant,
    log: Log,
    names: Sequence[str],
    n: int,
    seed: int,
    start: Mapping[str, float] | None = None,
    spread: float = 0.5,
    options: Options | None = None,
    progress: Progress | None = None,
) -> Starts:
    """Search from the given start, then from others around it, until one ends near the noise floor.

    Args:
        plant: the model.
        log: the log that is fitted.
        names: the free parameters.
        n: largest number of starts, the given one included.
        seed: seed of the random numbers for the other starts.
        start: starting values by name; the plant's own where not given.
        spread: largest distance of a start from the given one, in ln(value) of a positive
            parameter; a tenth of it for the others, in units of their scale (m, rad).
        options: how to search.
        progress: is told one line per accepted step.

    Raises:
        InputError: n is less than one, or for the reasons of `estimate`.
        DivergenceError: no start can be simulated.
    """
    if n < 1:
        raise InputError(f"{n} starts; give one or more")
    known = {**plant.parameters.values(), **(start or {})}
    first = np.array([known[plant.parameters[name].name] for name in names])
    space = coordinates(plant.parameters, names, first)
    values = _around(space, first, n, spread, seed)
    floor = by_unit(noise_floor(log.outputs), log)
    best: Estimate | None = None
    costs: list[float] = []
    rms: list[float] = []
    for k, row in counted(enumerate(values), "starts", len(values)):
        begins_at = {**(start or {}), **dict(zip(names, row.tolist(), strict=True))}
        try:
            found = estimate(plant, log, names, begins_at, options, progress)
            error = _error(found)
        except InputError:
            if k == 0:
                raise
            costs.append(np.inf)  # the plant cannot start with these values
            rms.append(np.inf)
            continue
        except DivergenceError as lost:
            costs.append(np.inf)
            rms.append(np.inf)
            reason = lost
            continue
        ended = _cost(found, error, space.encode(first))
        if best is None or ended < min(costs):
            best = found
        costs.append(ended)
        rms.append(float(np.sqrt(np.mean(error**2))))
        is_enough = relative(rms_by_unit(error, log), floor) < ENOUGH_NOISE_RATIO
        if is_enough or found.status == "stopped":
            break
    if best is None:
        raise reason
    return Starts(best, np.array(costs), np.array(rms), values[: len(costs)])


def _around(space: Coordinates, first: np.ndarray, n: int, spread: float, seed: int) -> np.ndarray:
    """Returns the first start and n - 1 others around it, inside the bounds, shape (n, p)."""
    q = space.encode(first)
    reach = np.where(space.logarithmic, spread, LINEAR_SPREAD_SHARE * spread)
    low, high = np.maximum(space.lower, q - reach), np.minimum(space.upper, q + reach)
    share = np.random.default_rng(seed).uniform(0.01, 0.99, (n - 1, len(q)))
    return np.concatenate([first[None], space.decode(low + share * (high - low))])


def _error(found: Estimate) -> np.ndarray:
    """Returns y - ŷ at the end of a search, shape (n, ny)."""
    predicted = found.predictor.predict(found.space.decode(found.q))[0]
    return np.asarray(found.predictor.log.outputs - predicted)


def _cost(found: Estimate, error: np.ndarray, known: np.ndarray) -> float:
    """Returns V at the end of a search.

    Args:
        found: where it ended.
        error: ε = y - ŷ there, shape (n, ny).
        known: q̄, what was known of each parameter before, shape (p,).
    """
    options, log = found.options, found.predictor.log
    weighed = relative_weight(log.outputs, options.relative_noise) * error
    prior = (found.q - known) * found.priors.weight
    if options.criterion == "det":
        _, size = np.linalg.slogdet(whitener_of(weighed))  # log det Λ = -2 log det C
        return float(-2 * len(error) * size + prior @ prior)
    r = np.concatenate([(weighed @ found.whitener.T).ravel(), prior])
    return float(np.sum(LOSSES[options.loss].value(r**2)))
