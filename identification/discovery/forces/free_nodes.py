"""A curve of free nodes in the place of a law, and how outputs respond to it.

    f_i = Σ_j c_j h_j(x_i)        h_j: hats about the nodes x_j, which add up to one

A friction jumps where the motion turns, so that a curve of the rate has nodes of its own on each
side of zero.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.discovery.forces.force_along import ForceAlong
from identification.discovery.forces.law_regressors import Regressor
from identification.kalman import response

CURVE_NODES = 20  # in the place of a law; half as many on each side of zero
MIN_NODE_DISTANCE = 2e-3  # of the range of x: nodes nearer than this are one
MIN_NODE_SAMPLES = 10  # between two nodes
MAX_FORCE_POINTS = 4000  # at which a recovered force is looked at: its curve needs no more


@dataclass(frozen=True)
class Nodes:
    """Nodes of a curve."""

    x: np.ndarray  # where they are, shape (m,)
    side: np.ndarray  # 1 or -1 where a node acts on that side of zero only, else 0, shape (m,)

    def hats(self, x: np.ndarray) -> np.ndarray:
        """Returns the hat functions of the nodes at some places, shape (*x.shape, m)."""
        out = np.zeros((*x.shape, len(self.x)))
        for side in np.unique(self.side):
            mine = np.flatnonzero(self.side == side)
            here = np.ones(x.shape, bool) if side == 0 else (x < 0 if side < 0 else x >= 0)
            for k, row in zip(mine, np.eye(len(mine)), strict=True):
                out[..., k] = np.where(here, np.interp(x, self.x[mine], row), 0.0)
        return out


def place_nodes(regressor: Regressor, force: np.ndarray) -> Nodes:
    """Returns nodes where the samples are, and as many where a law bends, so that they show it.

    Args:
        regressor: what the force follows.
        force: of the law, shape (M, n); it says where the nodes are, and not what is found there.
    """
    x, f = regressor.samples(force)
    order = np.argsort(x, kind="stable")
    x, f = x[order], f[order]
    if regressor.along != "rate":
        at = _between(x, f, CURVE_NODES)
        return Nodes(at, np.zeros(len(at), int))
    parts = [(s, s * x > 0) for s in (-1, 1)]
    sides = [(s, of) for s, of in parts if of.sum() >= MIN_NODE_SAMPLES]
    each = [(s, _between(x[of], f[of], CURVE_NODES // 2)) for s, of in sides]
    return Nodes(
        np.concatenate([at for _, at in each]),
        np.concatenate([np.full(len(at), s) for s, at in each]),
    )


def _between(x: np.ndarray, force: np.ndarray, count: int) -> np.ndarray:
    """Returns nodes over ascending x: half of them by the samples, half by the law's changes."""
    share = np.linspace(0, 1, count // 2 + 1)
    few = x[:: max(1, len(x) // MAX_FORCE_POINTS)]
    law = np.interp(few, x, force)
    changed = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(law)))])
    bends = np.interp(share * changed[-1], changed, few)
    kept = [x[0]]
    for node in np.union1d(np.quantile(x, share), bends):
        between = np.searchsorted(x, node) - np.searchsorted(x, kept[-1])
        if node - kept[-1] > MIN_NODE_DISTANCE * (x[-1] - x[0]) and between >= MIN_NODE_SAMPLES:
            kept.append(node)
    return np.array(kept)


def respond(along: ForceAlong, regressor: Regressor, nodes: Nodes) -> np.ndarray:
    """Returns the outputs for a unit force at each node, shape (N, ny, m)."""
    hats = nodes.hats(regressor.values) * regressor.turn[..., None]
    out, done = [], 0
    for linear in along.stretches:
        trajectory = linear.along
        mine = trajectory.average(hats[done : done + len(trajectory.time)])
        done += len(trajectory.time)
        read = np.flatnonzero(linear.C.any(axis=0))
        none = np.zeros((hats.shape[-1], linear.A.shape[1]))
        forces = np.moveaxis(mine, -1, 0)
        x = response.respond(linear.A, linear.B, none, forces, trajectory.intervals, read)
        out.append(np.moveaxis(x @ linear.C[:, read].T, 0, -1))
    return np.concatenate(out)
