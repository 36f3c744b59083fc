"""Curves that no law gives: does what an effect explains follow one of them instead?

    f_i = Σ_j c_j h_j(s_i)        h_j: hats with eight nodes; s_i: of joint i the rate, the position
                                  or the input, or the time

The nearest neighbour in the catalogue of an effect that is not in it explains a part, and leaves a
pattern that a curve takes. Only where a curve explains more than chance beside all named effects is
it compared with each of them (`replacement`), under the noise with both.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from identification.discovery.missing_forces import list_actuated_joints
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import CURVE, Candidate, Effect
from identification.effects.laws.curves import NODES
from identification.effects.sizes import Size
from identification.innovations.scoring.scores import score
from identification.innovations.scoring.sensitivities import Sensitivity
from identification.innovations.scoring.significance import correct_p_value
from identification.kalman.linear import Linearisation, linearise_records
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.refit import Refit
from identification.kalman.response import respond
from identification.logs.log import Log

ALL = "the actuated joints"


@dataclass(frozen=True)
class Curve:
    """A curve that explains a part of what a fit leaves."""

    sensitivity: Sensitivity  # of the outputs, to the force at each of its nodes
    level: NoiseLevel  # the noise of the fit with the curve beside all that it has


def find_curves(fit: Refit, options: DiscoveryOptions) -> tuple[Curve, ...]:
    """Returns the curves that explain more than chance of what a fit leaves, the best first.

    The noise is that of the fit, which takes for an error of the inputs a part of what a law
    leaves: a curve takes errors of the inputs as well, so that no smaller noise is believed.

    Args:
        fit: the fit with all named effects.
        options: what is beyond chance.

    Raises:
        DivergenceError: the model cannot be simulated.
    """
    curves = list_curves(fit)
    scores = score(fit, curves, options) if curves else ()
    every = {s.candidate.key: s for s in curves}
    return tuple(
        Curve(every[s.candidate.key], s.level)
        for s in scores
        if correct_p_value(s, len(scores)) < options.significance
    )


def list_curves(fit: Refit) -> tuple[Sensitivity, ...]:
    """Returns sensitivities to the nodes of each curve: of all actuated joints, and of each one."""
    predictor, space, q = fit.point.predictor, fit.point.space, fit.point.q
    model = predictor.plant.model
    joints = list_actuated_joints(model)
    if not joints:
        return ()
    dofs = [int(model.jnt_dofadr[j]) for j in joints]
    records = linearise_records(predictor, space.decode(q), forces=dofs)
    logs = [record.log for record, _ in predictor.records()]
    each = [_regressors(r, log, joints) for r, log in zip(records, logs, strict=True)]
    out = []
    for along in each[0]:
        nodes = _place_nodes(np.concatenate([of[along].ravel() for of in each]))
        hats = [_hats(of[along], nodes) for of in each]
        S = np.concatenate([_respond(r, h) for r, h in zip(records, hats, strict=True)])
        out.append(Sensitivity(_curve(along, ALL), S.sum(axis=2)))
        for i, j in enumerate(joints if len(joints) > 1 else ()):
            out.append(Sensitivity(_curve(along, model.joint(j).name), S[:, :, i]))
    return tuple(out)


def _curve(along: str, where: str) -> Candidate:
    sizes = tuple(Size(f"c_{j}", "", np.inf, 1.0) for j in range(1, NODES + 1))
    places = {where: "" if where == ALL else f"@{where}"}
    return Candidate(Effect(f"{CURVE}_{along}", f"f({along})", sizes, places=places), where, {})


def _regressors(
    linear: Linearisation, log: Log, joints: Mapping[int, int]
) -> dict[str, np.ndarray]:
    """Returns regressors of a force at all samples but a record's last, shape (N-1, n) each."""
    along, of = linear.along, list(joints)
    out = {
        "rate": along.states["qvel"][:-1, along.model.jnt_dofadr[of]],
        "position": along.states["qpos"][:-1, along.model.jnt_qposadr[of]],
        "time": np.repeat(log.time[:-1, None], len(of), axis=1),
    }
    if max(joints.values()) < log.inputs.shape[1]:
        out["input"] = log.inputs[:-1, list(joints.values())]
    return out


def _place_nodes(s: np.ndarray) -> np.ndarray:
    """Returns nodes with equally many samples in between, shape (m,); fewer if values repeat."""
    return np.unique(np.quantile(s, np.linspace(0, 1, NODES)))


def _hats(s: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    """Returns hat functions that add up to one, shape (*s.shape, NODES); zero for missing nodes."""
    out = np.zeros((*s.shape, NODES))
    for j in range(len(nodes)):
        out[..., j] = np.interp(s, nodes, np.eye(len(nodes))[j])
    return out


def _respond(linear: Linearisation, hats: np.ndarray) -> np.ndarray:
    """Returns the outputs for unit forces that follow hats (N-1, n, m), shape (N, ny, n, m)."""
    plant = linear.at_samples()
    read, none = np.flatnonzero(plant.C.any(axis=0)), np.zeros((hats.shape[2], plant.A.shape[1]))
    each = [
        respond(plant.A, plant.B[:, :, [i]], none, own.T[..., None], 1, read)
        for i, own in enumerate(np.moveaxis(hats, 1, 0))
    ]
    return np.einsum("imkr,yr->kyim", np.array(each), plant.C[:, read])
