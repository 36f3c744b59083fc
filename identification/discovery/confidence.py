"""How sure a name is: against its rivals, and against what it leaves unexplained.

    P_j ∝ exp(-ΔBIC_j/(2 T))        over the explanations that were refitted in its place, and
                                    over none: the base parameters farther off (`retuned`)

T > 1 because the likelihood believes its noise model, and the cap because no effect is certain that
was confirmed under one kind of input only. Both are judgement: `benchmarks/discovery.py` prints how
well the confidence is calibrated on simulated worlds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from threadpoolctl import threadpool_limits

from identification.discovery.fitted_model import AcceptedEffect, FittedModel, collect_parameters
from identification.discovery.nominal_model import NominalModel
from identification.discovery.result import Named, Rival
from identification.discovery.retuning import retuned
from identification.discovery.scoring.sensitivities import Sensitivity
from identification.effects.effect import Candidate
from identification.kalman.noise_model import build_whitener

TEMPERATURE = 10.0
CAP = 0.95
LIKELY = 0.2  # a rival as likely as this makes a set


def name_effects(
    base: NominalModel,
    accepted: Sequence[AcceptedEffect],
    final: FittedModel,
    columns: Sequence[Sensitivity],
    explained: float,
) -> tuple[Named, ...]:
    """The accepted effects with their final values and their rivals.

    Args:
        base: the nominal model.
        accepted: effects in the order in which they were added.
        final: the model with all of them.
        columns: sensitivities of all candidates.
        explained: share of what should be explained that they explain together, 0 to 1.
    """
    point = final.refit.point
    values = point.values
    out = []
    named = {_key(a.step) for a in accepted}
    for new in accepted:
        mine = new.step.candidates[-1]
        others = [s for s in new.others if _key(s) not in named]  # one that is there is no rival
        loss, other = retuned(final.refit, base.names, mine)
        spared = len(mine.free) * np.log(len(point.log))
        near = [new.step, *others]
        worth = np.array([s.criterion for s in near] + [new.step.criterion - loss + spared])
        weights = np.exp((worth - worth.max()) / (2 * TEMPERATURE))
        probability = weights / weights.sum()
        rivals = [s.candidates[-1] for s in others]
        alike = _alike(base, final, mine, rivals, columns)
        shape = {s.name: values[mine.effect.parameter(s.name, mine.where)]
                 for s in mine.effect.shapes}  # fmt: skip
        out.append(
            Named(
                replace(mine, shape=shape),
                collect_parameters(base, final, mine),
                float(min(CAP, probability[0]) * min(1.0, max(0.0, explained))),
                tuple(
                    Rival(r, float(p), a)
                    for r, p, a in zip(rivals, probability[1:-1], alike, strict=True)
                ),
                bool(others and probability[1:-1].max() > LIKELY),
                new.gain,
                new.proof,
                replace(other, confidence=float(probability[-1])),
            )
        )
    return tuple(out)


def _key(step: FittedModel) -> tuple[str, str]:
    """The effect that a model added last, and where."""
    return step.candidates[-1].effect.name, step.candidates[-1].where


def _nearest(candidate: Candidate, columns: Sequence[Sensitivity]) -> np.ndarray:
    """The sensitivity whose shapes are nearest to a candidate's."""

    def far(c: Sensitivity) -> float:
        return sum(abs(c.candidate.shape[n] - v) for n, v in candidate.shape.items())

    return min(columns, key=far).S


def _alike(
    base: NominalModel,
    final: FittedModel,
    mine: Candidate,
    rivals: Sequence[Candidate],
    columns: Sequence[Sensitivity],
) -> list[float]:
    """Cosines between the sensitivity of an effect and those of its rivals, whitened."""
    known: dict[tuple[str, str], list[Sensitivity]] = {}
    for c in columns:
        known.setdefault((c.candidate.effect.name, c.candidate.where), []).append(c)
    wanted = [_nearest(c, known[c.effect.name, c.where]) for c in (mine, *rivals)]
    point, level = final.refit.point, final.refit.level
    keep = [i for i, name in enumerate(point.space.names) if name in base.names]
    with threadpool_limits(1, "blas"):
        filter_ = build_whitener(point.linear, level.noise, point.log.sampling_time)
        W = filter_(np.concatenate([point.J[..., keep], *wanted], axis=2)).reshape(point.e.size, -1)
    F, S = W[:, : len(keep)], W[:, len(keep) :]
    ridge = np.diag((final.refit.prior[keep] * level.sigma) ** 2)
    S = S - F @ np.linalg.solve(F.T @ F + ridge, F.T @ S)
    ends = np.cumsum([w.shape[2] for w in wanted])
    spans = [np.linalg.qr(S[:, e - w.shape[2] : e])[0] for e, w in zip(ends, wanted, strict=True)]
    return [float(np.linalg.norm(spans[0].T @ span, 2)) for span in spans[1:]]
