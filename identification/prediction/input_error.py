"""The error of the inputs that would explain what a fitted model leaves.

    Σ_w ‖r⊥_w‖² = σ² n + α² Σ_w ‖S⊥_w‖²           α: rms error of the inputs, a share of their rms

S = -∂r/∂u, u the inputs in units of their rms, each error constant over a window; r⊥, S⊥: residual
and sensitivity without what the state of a window makes up for; n: readings less the states that
they tell, σ: the sensors' noise. No log has exact inputs: a drive's current or a commanded torque
is good to some per cent. What so small an error of the inputs makes is no reason to seek an effect.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from identification.prediction.fit import WindowFit
from identification.windows.shooting import Shooting, Tangent

INPUT_STEP = 1e-3  # of an input's rms, by which it is moved


def needed_input_error(fit: WindowFit, floor: float) -> float:
    """Returns the inputs' rms error over a window that the residual needs, as a share of their rms.

    Args:
        fit: the model, on the windows of the records that were fitted.
        floor: σ², mean square of the sensors' noise in units of the errors' scale.
    """
    inputs = np.concatenate([p.predictor.log.inputs for p in fit.problem.parts])
    size = np.sqrt(np.mean(inputs**2, axis=0))
    moving = np.flatnonzero(size > 0)
    if not len(moving):  # in a free swing, no error of the inputs is a share of their size
        return np.inf
    left, felt = 0.0, 0.0
    for k, (part, d, t) in enumerate(zip(fit.problem.parts, fit.moves, fit.tangents, strict=True)):
        q = fit.q[fit.problem.unknowns.columns(k)]
        readings = part.cut.outputs.size - t.freedom
        left += float(np.sum(t.projected[1] ** 2)) - floor * readings
        felt += float(np.sum(_sensitivity(part, q, d, t, size, moving) ** 2))
    return float(np.sqrt(max(0.0, left) / felt)) if felt > 0 else np.inf


def _sensitivity(
    part: Shooting, q: np.ndarray, d: np.ndarray, t: Tangent, size: np.ndarray, moving: np.ndarray
) -> np.ndarray:
    """Returns S⊥ of the inputs that move, each in units of its rms, shape (W, m, k)."""
    out = []
    at = part.joined(part.outputs(q[None], [d], is_rough=True)[0], d)
    for j in moving:
        step = np.zeros(len(size))
        step[j] = INPUT_STEP * size[j]
        log = replace(part.predictor.log, inputs=part.predictor.log.inputs + step)
        moved = replace(
            part, predictor=replace(part.predictor, log=log),
            cut=replace(part.cut, inputs=part.cut.inputs + step),
        )  # fmt: skip
        r = part.joined(moved.outputs(q[None], [d], is_rough=True)[0], d)
        out.append((at - r) / INPUT_STEP)
    S = np.stack(out, axis=-1)
    U = t.U * (t.s > 0)[:, None]
    return np.asarray(S - U @ (np.swapaxes(U, 1, 2) @ S))
