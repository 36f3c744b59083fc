"""The force that a model lacks, recovered from the data, beside the law that was named.

    e = y - ŷ(θ̂),   f̂_j = f(x_j; θ̂) + ĉ_j,   ĉ = argmin ‖W (e - Σ_j c_j s_j)‖²

s_j is the response of the outputs to a unit force that follows a hat about the node x_j, W the
whitening filter of the noise. This is one step of Gauss and Newton of another model, which has in
the place of the law a curve of free nodes. It begins where the law is, but nothing holds the nodes
there: had the data another curve than the law's, the points f̂_j would leave the law for it.

The other parameters stay as the final fit has them: a curve of the rate could take over what
viscous and Coulomb friction do, and nothing would tell how much of it. The band about the law holds
what is not known of the law's own parameters, and the bars of the points the noise alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from identification.discovery.effect_results import Rival
from identification.discovery.force_along import ACTS, force_along
from identification.discovery.free_nodes import MOST, Nodes, place_nodes, respond
from identification.discovery.law_regressors import (
    Regressor,
    find_reading,
    find_regressor,
    unexplained,
)
from identification.effects.effect import Candidate
from identification.kalman.noise_model import build_whitener
from identification.kalman.problem import linearise_criterion
from identification.kalman.refit import Refit

LINE = 60  # bins of a law's line
STEP = 0.1  # of a std: for the derivatives of a law by its parameters
MIXED = 0.2  # u of a force that is shown as a function of one quantity, at most
NEAR = 200  # one of so many samples is near to a node
WEAK = 1.0  # of the law's largest force: a point with a larger std tells nothing


@dataclass(frozen=True)
class LawLine:
    """A law along what it depends on.

    Attributes:
        x: shape (n,).
        force: shape (n,).
        std: by the covariance of its parameters, shape (n,); zeros where that is not known.
    """

    x: np.ndarray
    force: np.ndarray
    std: np.ndarray


@dataclass(frozen=True, kw_only=True)
class RecoveredForce:
    """A force recovered from the data, the law that was named for it, and those of its rivals.

    Attributes:
        candidate: the named effect.
        along: what its force follows: "rate", "position", "phase", "time", "drive" (the force of
            the joint's own drives), "law" (what the law multiplies by its size) or "reading" (of
            a sensor, whose error is then what is recovered).
        resists: whether the force is counted against the motion, as frictions are.
        units: of what it follows, and of the force.
        points: of the free curve; their std is that of the noise alone.
        law: with the named effect's values.
        rivals: what each rival's model has in the place of the law.
        places: on how many degrees of freedom it acts.
    """

    candidate: Candidate
    along: str
    resists: bool
    units: tuple[str, str]
    points: LawLine
    law: LawLine
    rivals: tuple[tuple[Candidate, LawLine], ...]
    places: int


def recover_force(
    fit: Refit,
    candidate: Candidate,
    rivals: Sequence[Rival] = (),
) -> RecoveredForce | None:
    """The force of an effect, recovered from the fitted samples.

    Args:
        fit: with the effect.
        candidate: the effect.
        rivals: what else was fitted in its place.

    Returns:
        None where the effect makes no force, or forces that are no function of one quantity of
        each joint, as that of a cable on a platform.

    Raises:
        DivergenceError: the model cannot be simulated.
    """
    values = fit.point.values
    base = {**values, **dict.fromkeys(candidate.sizes, 0.0)}
    rivals = [r for r in rivals if r.values]
    steps = _law_steps(fit, candidate)
    moved = [{**values, name: values[name] + step} for name, step in steps.items()]
    sets = [values, *moved, *({**r.values, **_absent(base, r.values)} for r in rivals)]
    with threadpool_limits(1, "blas"):
        find = _of_readings if "reading" in candidate.effect.hooks else _of_forces
        shown = find(fit, candidate, values, base, sets)
        if shown is None or unexplained(shown.follows, shown.forces[0]) > MIXED:
            return None
        c, std = _solve(fit, fit.point.log.outputs - shown.predicted, shown.response)
    x, nodes = shown.follows, shown.nodes
    edges = _edges(x, shown.forces[0])
    lines = [_line(x, force, edges) for force in shown.forces]
    return RecoveredForce(
        candidate=candidate,
        along=x.along,
        resists=x.resists,
        units=(x.unit, x.force_unit),
        points=_points(nodes, x.samples(shown.forces[0]), c, std),
        law=_with_band(fit, lines[0], lines[1 : 1 + len(steps)], steps),
        rivals=tuple(
            (r.candidate, line) for r, line in zip(rivals, lines[1 + len(steps) :], strict=True)
        ),
        places=x.values.shape[1],
    )


@dataclass(frozen=True)
class _Shown:
    """What is drawn of some sets of values, the first of them the law's, and what it rests on."""

    follows: Regressor
    nodes: Nodes
    forces: tuple[np.ndarray, ...]
    predicted: np.ndarray
    response: np.ndarray


def _of_forces(
    fit: Refit, candidate: Candidate, values: Mapping[str, float], base: Mapping[str, float],
    sets: Sequence[Mapping[str, float]],
) -> _Shown | None:  # fmt: skip
    """Forces on joints; None where the law has none, or not on joints of one kind alone."""
    along = force_along(fit.point.predictor, values, base, sets)
    if along is None:
        return None
    x = find_regressor(candidate, values, along)
    nodes = place_nodes(x, along.forces[0])
    return _Shown(x, nodes, along.forces, along.predicted, respond(along, x, nodes))


def _of_readings(
    fit: Refit, candidate: Candidate, values: Mapping[str, float], base: Mapping[str, float],
    sets: Sequence[Mapping[str, float]],
) -> _Shown | None:  # fmt: skip
    """Errors of sensors: what they say beyond what a perfect one would."""
    predictor = fit.point.predictor
    own, *others = (
        replace(predictor, names=tuple(v), fixed={}).predict(np.array([[*v.values()]]))[0]
        for v in (base, *sets)
    )
    errors = [other - own for other in others]
    rms = np.sqrt(np.mean(errors[0] ** 2, axis=0))
    at = np.flatnonzero(rms > ACTS * rms.max())
    if not rms.max() > 0:
        return None
    x = find_reading(predictor.log, own, errors[0], at.tolist())
    nodes = place_nodes(x, errors[0][:, at])
    S = np.zeros((*own.shape, len(nodes.x)))
    S[:, at] = nodes.hats(x.values)
    return _Shown(x, nodes, tuple(e[:, at] for e in errors), others[0], S)


def _law_steps(fit: Refit, candidate: Candidate) -> dict[str, float]:
    """Steps for derivatives of a law by its free parameters, by name, in their units."""
    space = fit.point.space
    std = dict(zip(space.names, fit.std * space.slope(fit.point.q), strict=True))
    return {name: STEP * float(std[name]) for name in candidate.estimated if std.get(name)}


def _absent(values: Mapping[str, float], others: Mapping[str, float]) -> dict[str, float]:
    """Parameters that other values do not name, as a base has them."""
    return {name: value for name, value in values.items() if name not in others}


def _solve(fit: Refit, e: np.ndarray, S: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The forces at the nodes that are likeliest, and their std, each of shape (m,)."""
    point, level = fit.point, fit.level
    filter_ = build_whitener(point.linear, level.noise, point.log.sampling_time)
    E, F = filter_(e).ravel(), filter_(S).reshape(e.size, -1)
    covariance = np.linalg.pinv(F.T @ F, rcond=1e-12, hermitian=True)
    felt = np.diag(F.T @ F) > 0
    std = np.where(felt, level.sigma * np.sqrt(np.diag(covariance)), np.inf)
    return covariance @ (F.T @ E), std


def _edges(x: Regressor, law: np.ndarray) -> np.ndarray:
    """Bins of what is followed: even ones, ones of equally many samples, ones where a law bends."""
    at, f = x.samples(law)
    order = np.argsort(at, kind="stable")
    few = at[order][:: max(1, len(at) // MOST)]
    force = np.interp(few, at[order], f[order])
    changed = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(force)))])
    share = np.linspace(0, 1, LINE + 1)
    bends = np.interp(share * changed[-1], changed, few)
    even = at.min() + share * np.ptp(at)
    turn = [0.0] if x.along == "rate" and at.min() < 0 < at.max() else []
    return np.unique(np.concatenate([even, np.quantile(at, share), bends, turn]))


def _line(x: Regressor, force: np.ndarray, edges: np.ndarray) -> LawLine:
    """A force (M, n) along what it follows: means over bins."""
    at, f = x.samples(force)
    which = np.clip(np.searchsorted(edges, at, side="right") - 1, 0, len(edges) - 2)
    count = np.bincount(which, minlength=len(edges) - 1)
    seen = count > 0
    mean = [np.bincount(which, of, len(edges) - 1)[seen] / count[seen] for of in (at, f)]
    return LawLine(mean[0], mean[1], np.zeros(int(seen.sum())))


def _with_band(
    fit: Refit, law: LawLine, moved: list[LawLine], steps: Mapping[str, float]
) -> LawLine:
    """A law with the std that the covariance of its parameters gives it."""
    if not steps:
        return law
    point = fit.point
    at = [point.space.names.index(name) for name in steps]
    covariance = linearise_criterion(point, fit.level, fit.mean, fit.prior).covariance
    slope = point.space.slope(point.q)[at]
    P = covariance[np.ix_(at, at)] * np.outer(slope, slope)
    G = np.stack(
        [(m.force - law.force) / step for m, step in zip(moved, steps.values(), strict=True)], 1
    )
    return LawLine(law.x, law.force, np.sqrt(np.einsum("ni,ij,nj->n", G, P, G)))


def _points(
    nodes: Nodes, law: tuple[np.ndarray, np.ndarray], c: np.ndarray, std: np.ndarray
) -> LawLine:
    """The points of the free curve, but for those of which the samples tell nothing."""
    at = np.array([_at(*law, x, side) for x, side in zip(nodes.x, nodes.side, strict=True)])
    told = std < WEAK * np.abs(law[1]).max()
    return LawLine(nodes.x[told], (at + c)[told], std[told])


def _at(x: np.ndarray, force: np.ndarray, node: float, side: int) -> float:
    """A law at a node: a straight line through the samples about it, on its side of zero."""
    mine = x * side >= 0 if side else np.ones(len(x), bool)
    x, force = x[mine] - node, force[mine]
    near = np.argsort(np.abs(x))[: max(3, len(x) // NEAR)]
    if np.ptp(x[near]) == 0:
        return float(force[near].mean())
    return float(np.polynomial.Polynomial.fit(x[near], force[near], 1)(0.0))
