"""The force that a model lacks, recovered from the data, beside the law that was named.

    e = y - ŷ(θ̂),   f̂_j = f(x_j; θ̂) + ĉ_j,   ĉ = argmin ‖W (e - Σ_j c_j s_j)‖²

s_j is the response of the outputs to a unit force that follows a hat about the node x_j, W what
whitens the noise. This is one step of Gauss and Newton of another model, which has in the place of
the law a curve of free nodes. It begins where the law is, but nothing holds the nodes there: had
the data another curve than the law's, the points f̂_j would leave the law for it.

The other parameters stay as the final fit has them: a curve of the rate could take over what
viscous and Coulomb friction do, and nothing would tell how much of it. The band about the law holds
what is not known of the law's own parameters, and the bars of the points the noise alone.
`identification.innovations.recovery` recovers the forces of a free run, and
`identification.prediction.verdict.recovery` those of windows.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from identification.discovery.forces.force_along import MIN_ACTING_SHARE, ForceAlong
from identification.discovery.forces.free_nodes import MAX_FORCE_POINTS, Nodes, place_nodes, respond
from identification.discovery.forces.law_regressors import (
    Regressor,
    find_reading,
    find_regressor,
    unexplained,
)
from identification.effects.effect import Candidate
from identification.logs.log import Log

LINE_BINS = 60  # of a law's line
MAX_SHOWN_U = 0.2  # of a force that is shown as a function of one quantity
NEAR_NODE_DIVISOR = 200  # one of so many samples is near to a node
DERIVATIVE_STEP = 0.1  # of a std: for the derivatives of a law by its parameters
MAX_POINT_STD = 1.0  # of the law's largest force: a point with a larger std tells nothing


@dataclass(frozen=True)
class LawLine:
    """A law along what it depends on."""

    x: np.ndarray  # shape (n,)
    force: np.ndarray  # shape (n,)
    # by the covariance of its parameters, shape (n,); zeros where that is not known
    std: np.ndarray


@dataclass(frozen=True, kw_only=True)
class RecoveredForce:
    """A force recovered from the data, the law that was named for it, and those of its rivals."""

    candidate: Candidate  # the named effect
    # what its force follows: "rate", "position", "phase", "time", "drive" (the force of the joint's
    # own drives), "law" (what the law multiplies by its size) or "reading" (of a sensor, whose
    # error is then what is recovered)
    along: str
    resists: bool  # whether the force is counted against the motion, as frictions are
    units: tuple[str, str]  # of what it follows, and of the force
    points: LawLine  # of the free curve; their std is that of the noise alone
    law: LawLine  # with the named effect's values
    # what each rival's model has in the place of the law
    rivals: tuple[tuple[Candidate, LawLine], ...]
    places: int  # on how many degrees of freedom it acts


@dataclass(frozen=True)
class Shown:
    """Forces of some sets of values, the first of them the law's, and what they rest on."""

    follows: Regressor  # what the law's force follows, M points of n degrees of freedom
    nodes: Nodes  # m of them, of the free curve
    forces: tuple[np.ndarray, ...]  # of each set, shape (M, n) each
    predicted: np.ndarray  # outputs with the law, shape (N, ny)
    response: np.ndarray  # of the outputs to a unit force at each node, shape (N, ny, m)

    @property
    def is_mixed(self) -> bool:
        """Tells whether the law's force is no function of one quantity."""
        return unexplained(self.follows, self.forces[0]) > MAX_SHOWN_U


def show_forces(candidate: Candidate, values: Mapping[str, float], along: ForceAlong) -> Shown:
    """Returns forces on joints over the quantity that the first of them follows.

    Args:
        candidate: the effect.
        values: of the plant's parameters by name.
        along: the forces along trajectories.
    """
    x = find_regressor(candidate, values, along)
    nodes = place_nodes(x, along.forces[0])
    return Shown(x, nodes, along.forces, along.predicted, respond(along, x, nodes))


def show_readings(
    log: Log, own: np.ndarray, rate: np.ndarray, time: np.ndarray, readings: Sequence[np.ndarray]
) -> Shown | None:
    """Returns errors of sensors: their readings minus those of perfect sensors.

    Args:
        log: that has the outputs.
        own: what perfect sensors would say, shape (N, ny).
        rate: of these, shape (N, ny).
        time: of the samples in their record, shape (N,) [s].
        readings: with the named effect, and with others, shape (N, ny) each.

    Returns:
        None where the sensors have no error.
    """
    errors = [said - own for said in readings]
    rms = np.sqrt(np.mean(errors[0] ** 2, axis=0))
    at = np.flatnonzero(rms > MIN_ACTING_SHARE * rms.max())
    if not rms.max() > 0:
        return None
    unit = log.units.get(log.output_names[int(at[0])], "")
    x = find_reading(own[:, at], rate[:, at], time, errors[0][:, at], unit)
    nodes = place_nodes(x, errors[0][:, at])
    S = np.zeros((*own.shape, len(nodes.x)))
    S[:, at] = nodes.hats(x.values)
    return Shown(x, nodes, tuple(e[:, at] for e in errors), readings[0], S)


@dataclass(frozen=True)
class Moved:
    """Steps by which the parameters of a law were moved, to see what is not known of it."""

    steps: np.ndarray  # in their units, shape (k,)
    covariance: np.ndarray  # of the parameters, shape (k, k)


def law_steps(candidate: Candidate, std: Mapping[str, float]) -> dict[str, float]:
    """Returns steps for derivatives of a law by its free parameters, by name, in their units.

    Args:
        candidate: the effect.
        std: of fitted values, by name, in their units; a parameter that no data tell is not moved.
    """
    known = {name: std.get(name, 0.0) for name in candidate.estimated}
    return {name: DERIVATIVE_STEP * float(s) for name, s in known.items() if 0 < s < np.inf}


def moved_by(
    steps: Mapping[str, float], names: Sequence[str], covariance: np.ndarray, slope: np.ndarray
) -> Moved:
    """Returns steps of a law's parameters, with the covariance that a fit gives these.

    Args:
        steps: by name, in the parameters' units.
        names: of the fit's p coordinates.
        covariance: of these, shape (p, p).
        slope: d value/d coordinate, shape (p,).
    """
    at = [list(names).index(name) for name in steps]
    return Moved(
        np.array([*steps.values()]),
        covariance[np.ix_(at, at)] * np.outer(slope[at], slope[at]),
    )


def compare_force(
    candidate: Candidate, shown: Shown, c: np.ndarray, std: np.ndarray, moved: Moved,
    rivals: Sequence[Candidate],
) -> RecoveredForce:  # fmt: skip
    """Returns the points of the free curve beside the law with its band and the laws of rivals.

    Args:
        candidate: the named effect.
        shown: forces of its law, of the law with each parameter moved, and of the rivals.
        c: what the free curve adds to the law at the nodes, shape (m,).
        std: of it, shape (m,).
        moved: the parameters that were moved.
        rivals: effects in the law's place.
    """
    x, k = shown.follows, len(moved.steps)
    edges = _edges(x, shown.forces[0])
    law, *lines = (_line(x, force, edges) for force in shown.forces)
    return RecoveredForce(
        candidate=candidate,
        along=x.along,
        resists=x.resists,
        units=(x.unit, x.force_unit),
        points=_points(shown.nodes, x.samples(shown.forces[0]), c, std),
        law=_with_band(law, lines[:k], moved),
        rivals=tuple(zip(rivals, lines[k:], strict=True)),
        places=x.values.shape[1],
    )


def _with_band(law: LawLine, moved: Sequence[LawLine], by: Moved) -> LawLine:
    """Returns a law with the std that the covariance of its parameters gives it."""
    if not len(by.steps):
        return law
    slopes = [(m.force - law.force) / h for m, h in zip(moved, by.steps, strict=True)]
    G = np.stack(slopes, axis=1)
    return LawLine(law.x, law.force, np.sqrt(np.einsum("ni,ij,nj->n", G, by.covariance, G)))


def _edges(x: Regressor, law: np.ndarray) -> np.ndarray:
    """Returns bin edges: evenly spaced, at equally many samples, and where a law bends."""
    at, f = x.samples(law)
    order = np.argsort(at, kind="stable")
    few = at[order][:: max(1, len(at) // MAX_FORCE_POINTS)]
    force = np.interp(few, at[order], f[order])
    changed = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(force)))])
    share = np.linspace(0, 1, LINE_BINS + 1)
    bends = np.interp(share * changed[-1], changed, few)
    even = at.min() + share * np.ptp(at)
    turn = [0.0] if x.along == "rate" and at.min() < 0 < at.max() else []
    return np.unique(np.concatenate([even, np.quantile(at, share), bends, turn]))


def _line(x: Regressor, force: np.ndarray, edges: np.ndarray) -> LawLine:
    """Returns a force (M, n) along what it follows, as means over bins."""
    at, f = x.samples(force)
    which = np.clip(np.searchsorted(edges, at, side="right") - 1, 0, len(edges) - 2)
    count = np.bincount(which, minlength=len(edges) - 1)
    seen = count > 0
    mean = [np.bincount(which, of, len(edges) - 1)[seen] / count[seen] for of in (at, f)]
    return LawLine(mean[0], mean[1], np.zeros(int(seen.sum())))


def _points(
    nodes: Nodes, law: tuple[np.ndarray, np.ndarray], c: np.ndarray, std: np.ndarray
) -> LawLine:
    """Returns the points of the free curve, without those that the samples hardly determine."""
    at = np.array([_at(*law, x, side) for x, side in zip(nodes.x, nodes.side, strict=True)])
    told = std < MAX_POINT_STD * np.abs(law[1]).max()
    return LawLine(nodes.x[told], (at + c)[told], std[told])


def _at(x: np.ndarray, force: np.ndarray, node: float, side: int) -> float:
    """Returns a law at a node, by a straight line through samples near it, on its side of zero."""
    mine = x * side >= 0 if side else np.ones(len(x), bool)
    x, force = x[mine] - node, force[mine]
    near = np.argsort(np.abs(x))[: max(3, len(x) // NEAR_NODE_DIVISOR)]
    if np.ptp(x[near]) == 0:
        return float(force[near].mean())
    return float(np.polynomial.Polynomial.fit(x[near], force[near], 1)(0.0))
