"""Columns of candidates: how the residuals of all windows change with each of their sizes.

    S_j = (I - U Uᵀ)(-∂r/∂η_j)           U: what the states of a window make up for

A group of forces on joints is propagated along the linearised steps of the windows
(`identification.prediction.scoring.directions`). All others are simulated, each size at its probe:
what changes a state that joints lack, an input, a sensor, a mass or an inertia. So are forces in
windows in which a limit or a contact acts, because the time of an impact is not smooth, and where
the steps have no linearisation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from identification.discovery.attempts import refuse_infinite
from identification.effects.effect import Candidate
from identification.model.coordinates import coordinates
from identification.model.parameter import ParameterSet
from identification.prediction.scoring.directions import directions
from identification.prediction.scoring.forced import Forces, acts_on_joints
from identification.prediction.scoring.joint_states import rows_for
from identification.windows.fit import WindowFit
from identification.windows.shooting import Tangent


def columns(fit: WindowFit, group: Sequence[Candidate], share: float = 1.0) -> list[np.ndarray]:
    """Returns S of the k sizes of some candidates, one array (W m, k) a record.

    Args:
        fit: the model without them.
        group: forces on joints, or other candidates.
        share: of their probes, by which sizes are moved.

    Raises:
        DivergenceError: one of them cannot be simulated.
    """
    is_forced = all(acts_on_joints(c.effect) for c in group)
    each = forces_of(fit) if is_forced else (None,) * len(fit.moves)
    out = []
    for k, (forces, t) in enumerate(zip(each, fit.tangents, strict=True)):
        W = len(t.r)
        is_smooth = np.zeros(W, bool) if forces is None else forces.along.is_smooth
        S = np.zeros((*t.r.shape, sum(len(c.sizes) for c in group)))
        if forces is not None and is_smooth.any():
            S = whitened(fit, k, _forced(forces, group, share))
        if not is_smooth.all():
            S[~is_smooth] = _simulated(fit, k, ~is_smooth, group, share)
        refuse_infinite(S)
        out.append(without_states(t, S).reshape(-1, S.shape[2]))
    return out


def whitened(fit: WindowFit, record: int, y: np.ndarray) -> np.ndarray:
    """Returns rows of the residual, (W, m, k), of changes of a record's outputs (W, L, ny, k)."""
    S = np.zeros((*fit.tangents[record].r.shape, y.shape[3]))
    each = np.einsum("ij,wljk->wlik", fit.problem.parts[record].whitener, y)
    S[:, : y.shape[1] * y.shape[2]] = each.reshape(len(y), -1, y.shape[3])
    return S


def without_states(t: Tangent, S: np.ndarray) -> np.ndarray:
    """Returns columns (W, m, k) of windows without what the states of these make up for."""
    U = t.U * (t.s > 0)[:, None]
    return np.asarray(S - U @ (np.swapaxes(U, 1, 2) @ S))


@lru_cache(maxsize=2)  # a search asks often about the same fit
def forces_of(fit: WindowFit) -> tuple[Forces | None, ...]:
    """Returns what evaluates forces along the windows of each record; None where nothing does."""
    out = []
    for k, (part, d) in enumerate(zip(fit.problem.parts, fit.moves, strict=True)):
        along = directions(part, fit.q[fit.problem.unknowns.columns(k)], d)
        out.append(None if along is None else Forces(along, _values(fit, k)))
    return tuple(out)


def _values(fit: WindowFit, record: int) -> dict[str, float]:
    """Returns the values of all parameters of the plant in a record."""
    part = fit.problem.parts[record]
    own = part.predictor.plant.parameters.values()
    return {**own, **part.predictor.fixed, **fit.of_record(record)}


def _probes(group: Sequence[Candidate], share: float) -> list[tuple[Candidate, str, float]]:
    """Returns each size of some candidates, with the step by which it is moved."""
    return [
        (c, name, (-size.probe if size.sign < 0 else size.probe) * c.probe * share)
        for c in group
        for name, size in zip(c.sizes, c.effect.sizes, strict=True)
    ]


def _forced(forces: Forces, group: Sequence[Candidate], share: float) -> np.ndarray:
    """Returns how outputs change with the sizes of forces, shape (W, L, ny, k)."""
    probes = _probes(group, share)
    τ = np.array([forces.of_size(*probe) for probe in probes])
    return forces.along.outputs(τ, np.array([h for *_, h in probes]))


def _simulated(
    fit: WindowFit, record: int, keep: np.ndarray, group: Sequence[Candidate], share: float
) -> np.ndarray:
    """Returns -∂r/∂η in some windows of a record by simulations, shape (W, m, k)."""
    part, d = fit.problem.parts[record].rows(keep), fit.moves[record][keep]
    parameters, own = part.predictor.plant.parameters, _values(fit, record)
    names = list(dict.fromkeys(
        [*fit.problem.unknowns.local.names, *(n for c in group for n in (*c.sizes, *c.fixed))]
    ))  # fmt: skip
    probes = _probes(group, share)
    rows = [[own[n] for n in names]]
    for c, name, probe in probes:
        rows.append([{**own, **c.fixed, name: own[name] + probe}[n] for n in names])
    values = np.array(rows)
    # the coordinates of plain values need no logarithm
    space = coordinates(parameters, names, inside(parameters, names, values[0]), linear=names)
    there, moves = rows_for(part, d, group, fit.of_record(record))
    rest = {n: v for n, v in part.predictor.fixed.items() if n not in names}
    predictor = replace(there.predictor, names=tuple(names), fixed=rest)
    y = replace(there, space=space, predictor=predictor).outputs(
        space.encode(values), moves, is_rough=True
    )
    r = np.stack([part.joined(one, d) for one in y], axis=-1)  # (W, m, 1 + k)
    return np.asarray((r[..., :1] - r[..., 1:]) / np.array([h for *_, h in probes]))


def inside(parameters: ParameterSet, names: Sequence[str], values: np.ndarray) -> np.ndarray:
    """Returns values a little inside the bounds, as coordinates ask of a start."""
    out = []
    for name, value in zip(names, values, strict=True):
        record = parameters[name]
        margin = 1e-9 * max(abs(value), record.scale)
        out.append(min(max(value, record.lower + margin), record.upper - margin))
    return np.array(out)
