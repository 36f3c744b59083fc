"""The input that would tell two look-alikes apart.

    d(u) = ‖(I - P) ∂ŷ/∂η η‖/σ,    P projects onto the nominal parameters and the rival

d is the distance, in std of the noise, between a record of the effect under the input u and the
nearest one that the rival and the nominal parameters can produce. It is computed for the log's own
input and for standard inputs, over the fitted duration.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from identification.discovery.effect_results import NamedEffect
from identification.discovery.result import Discovery
from identification.discovery.scoring.sensitivities import compute_sensitivities
from identification.effects.effect import Candidate
from identification.errors import DivergenceError
from identification.kalman.point import Point, evaluate_point
from identification.logs.log import Log
from identification.model.predictor import Predictor
from inca_mj.workflows.bench import standard_inputs
from inca_mj.workflows.discovery_model import run_of

TELLS = 5.0  # distance in std of the noise at which a record tells two look-alikes apart


@dataclass(frozen=True)
class Contrast:
    """An input, and the distance of two look-alikes under it.

    Attributes:
        name: of the input, in words.
        distance: d [std of the noise].
        own: the distance under the log's own input.
    """

    name: str
    distance: float
    own: float


def tell_apart(found: Discovery, named: NamedEffect) -> Contrast | None:
    """Returns the input that tells a named effect best from its first rival; None if none can."""
    fit, rival = run_of(found).final, named.rivals[0].candidate
    own = _distance(fit.point, fit.point.log, named.candidate, rival, fit.level.sigma)
    tried = {}
    for name, currents in standard_inputs(len(fit.point.log)):
        log = replace(fit.point.log, inputs=currents, extras={})
        try:
            tried[name] = _distance(fit.point, log, named.candidate, rival, fit.level.sigma)
        except DivergenceError:  # a cable becomes slack under this input
            continue
    if not tried:
        return None
    best = max(tried, key=tried.__getitem__)
    return Contrast(best, tried[best], own)


def told(found: Discovery) -> Discovery:
    """Returns the discovery, with advice on the input that would tell its look-alikes apart."""
    named = tuple(
        replace(n, advice=sentence(contrast))
        if n.one_of and n.rivals and (contrast := tell_apart(found, n)) is not None
        else n
        for n in found.named
    )
    return replace(found, named=named)


def sentence(contrast: Contrast) -> str:
    """Returns the advice: what to do next."""
    if contrast.distance < max(TELLS, 1.5 * contrast.own):
        return (
            "No input that was tried would tell them apart better"
            f" ({contrast.distance:.1f} std against {contrast.own:.1f} here): measure tension or"
            " pose too."
        )
    return (
        f"A record under {contrast.name} would tell them apart: they would lie"
        f" {contrast.distance:.0f} std of the noise from each other, here {contrast.own:.1f}."
    )


def _distance(point: Point, log: Log, named: Candidate, rival: Candidate, sigma: float) -> float:
    """Returns d under the inputs of a log, with both effects linearised about their absence."""
    values = point.values
    gone = dict.fromkeys(named.sizes, 0.0)
    keep = [i for i, n in enumerate(point.space.names) if not n.startswith(f"{named.effect.name}.")]
    names, q = tuple(point.space.names[i] for i in keep), point.q[keep]
    fixed = {n: v for n, v in {**values, **gone}.items() if n not in names}
    space = replace(
        point.space, names=names, logarithmic=point.space.logarithmic[keep],
        lower=point.space.lower[keep], upper=point.space.upper[keep],
        scale=point.space.scale[keep],
    )  # fmt: skip
    here = evaluate_point(Predictor(point.predictor.plant, log, names, fixed), space, q)
    mine, *theirs = (s.S for s in compute_sensitivities(here, [named, rival]))
    size = np.array([values.get(n, 0.0) or named.whole.get(n, 0.0) for n in named.sizes])
    S = np.concatenate([here.J, *theirs], axis=2).reshape(log.outputs.size, -1)
    Q = np.linalg.qr(S / (np.linalg.norm(S, axis=0) + 1e-300))[0]
    shown = (mine @ size).ravel()
    return float(np.linalg.norm(shown - Q @ (Q.T @ shown)) / sigma)
