"""Are the unseen samples predicted as well as the fitted ones? If not, the robot may have changed.

    δ = argmin ‖E - F δ‖² + Σ ((q_j + δ_j - q̄_j)/s_j)²        over all samples, F = ∂E/∂q

A fit that knows its parameters only roughly predicts unseen samples only roughly. The part of the
innovations that a small change δ of the parameters can explain is therefore removed; the rest is no
uncertainty of the parameters.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from identification.chances import mean_above_other
from identification.discovery.attempts import attempt
from identification.discovery.findings.evidence import RobotChange
from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.options import DiscoveryOptions
from identification.discovery.validation import Validation
from identification.kalman.point import evaluate_sensitivities
from identification.pool import one_blas_thread


def find_robot_change(validation: Validation, options: DiscoveryOptions) -> tuple[Finding, ...]:
    """Returns a change of the robot if unseen innovations are larger beyond chance; else nothing.

    Args:
        validation: the prediction of the whole log by a fitted model.
        options: what is beyond chance, and large enough to matter.
    """
    seen, E = validation.seen, validation.innovations
    fitted, blocks = E[seen], options.proof_blocks
    if not _is_larger(fitted, E[~seen], options):
        return ()
    # A small change of a parameter may make the simulation diverge.
    explained = attempt(None, partial(_explain, validation))
    remaining = E if explained is None else E - explained
    unseen = remaining[~seen]
    if not _is_larger(fitted, unseen, options):
        return ()
    ratio = _power(unseen).mean() / _power(fitted).mean()
    onset = find_onset(_power(fitted), _power(unseen), blocks)
    time = validation.log.time[~seen][onset]
    evidence = RobotChange(float(np.sqrt(ratio)), float(time))
    return (Finding(FindingKind.ROBOT_CHANGE, evidence),)


def find_onset(fitted: np.ndarray, unseen: np.ndarray, blocks: int) -> int:
    """Returns the index of the unseen sample from which on the power differs most from before.

    Args:
        fitted: power of each fitted sample, shape (n,).
        unseen: power of each unseen sample, shape (m,).
        blocks: number of blocks, to whose starts the index is rounded.
    """
    ends = np.array_split(np.arange(len(unseen)), blocks)
    a, b = np.log(_means(fitted, blocks)), np.log(_means(unseen, blocks))

    def difference(k: int) -> float:
        before, after = np.concatenate([a, b[:k]]), b[k:]
        n, m = len(before), len(after)
        return float((after.mean() - before.mean()) * np.sqrt(n * m / (n + m)))

    return int(ends[max(range(blocks), key=difference)][0])


def _means(power: np.ndarray, blocks: int) -> np.ndarray:
    return np.array([part.mean() for part in np.array_split(power, blocks)])


def _power(E: np.ndarray) -> np.ndarray:
    return np.asarray(np.mean(E**2, axis=1))


def _is_larger(fitted: np.ndarray, unseen: np.ndarray, options: DiscoveryOptions) -> bool:
    """Returns whether unseen innovations are larger, beyond chance and by enough to matter."""
    a, b = (_means(_power(E), options.proof_blocks) for E in (fitted, unseen))
    # The logarithm keeps a few blocks with large errors from looking like scatter only.
    p = mean_above_other(np.log(b), np.log(a))
    matters = b.mean() > (1 + options.min_structure_share) * a.mean()
    return bool(p < options.structure_level and matters)


def _explain(validation: Validation) -> np.ndarray:
    """Returns the part of innovations that a small parameter change explains, shape (N, ny)."""
    fit = validation.refit
    with one_blas_thread():
        J = evaluate_sensitivities(fit.point, validation.log)
        F = validation.filter(J).reshape(validation.e.size, -1) / fit.level.sigma
        rows = np.vstack([F, fit.priors.rows])
        target = np.concatenate([validation.innovations.ravel(), fit.priors.against(fit.point.q)])
        scale = np.linalg.norm(rows, axis=0) + 1e-300
        move = np.linalg.lstsq(rows / scale, target, rcond=1e-12)[0] / scale
    return np.asarray((F @ move).reshape(validation.e.shape))
