"""How the noise is shared out: σ s_i of each sensor, and ρ σ of all inputs.

    Ω = Σ_i σ² s_i² I_i + (ρ σ)² Σ_j T_j            covariance of the residual e of a free run
    x = Ω⁻¹ e,    q_i = xᵀ I_i x,    t_i = tr(Ω⁻¹ I_i)        of the inputs Σ T_j in place of I_i
    s_i² ← s_i² (q_i/t_i)^½        and likewise ρ²

I_i picks the samples of sensor i, and T_j is what errors of input j, of one variance, do to the
outputs. Each such step raises the likelihood, as it minimises a bound that touches it (Zhou, Hu,
Zhou and Lange 2019, "MM algorithms for variance components models"; at its fixed point the
derivatives 2 ∂log L/∂σ_i² = q_i - t_i are zero). The power 1 in place of ½ has the same fixed point
and comes there in fewer steps; it is taken as long as the likelihood rises with it.

A smoother gives all q and t in one pass back over the log, without a matrix of the log's length.
A sensor that rests has no residual. A least share keeps it from being taken for one without noise.
Nothing keeps an input from having no error.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.kalman.backwards import information, transpose_filter
from identification.kalman.linear import LinearPlant
from identification.kalman.noise_model import Noise, build_whitener

POWERS = (1.0, 0.5)  # of q/t: the quick one, and the one that raises the likelihood always
MAX_STEPS = 20
END_RISE = 0.1  # of a log likelihood in one step: far less than any choice between models asks
# Of the rms noise of outputs of the same unit. One of a count of an encoder that stands still is
# far less, and the residual of such an output is an error of the model and not of the encoder.
LEAST_SHARE = 0.05


@dataclass(frozen=True)
class Shared:
    """A noise and what the likelihood of a fixed residual says of it."""

    noise: Noise  # the noise
    log_likelihood: float  # with the likeliest σ, up to a constant that depends on the log only
    sensors: np.ndarray  # q_i/t_i of each sensor, shape (ny,)
    inputs: float  # the same of all inputs together, 1 where they have no error


def share_noise(
    plant: LinearPlant,
    noise: Noise,
    e: np.ndarray,
    sampling_time: float,
    kinds: Sequence[Hashable] = (),
) -> Shared:
    """Returns the likeliest shares of a noise, τ held.

    Args:
        plant: the linearised plant.
        noise: where the steps begin.
        e: residual, shape (N, ny).
        sampling_time: [s].
        kinds: of each output, such as its unit; only those of one kind compare. All do without any.
    """
    kinds = tuple(kinds) or (None,) * e.shape[1]
    best = judge_shares(plant, noise, e, sampling_time)
    for _ in range(MAX_STEPS):
        for power in POWERS:
            moved = _moved(best, power, kinds, plant.B.shape[2])
            new = judge_shares(plant, moved, e, sampling_time)
            rise = new.log_likelihood - best.log_likelihood
            if rise > 0:
                best = new
                break
        if rise < END_RISE:
            break
    return best


def judge_shares(
    plant: LinearPlant, noise: Noise, e: np.ndarray, sampling_time: float
) -> Shared:  # fmt: skip
    """Returns the likelihood of a residual (N, ny) under a noise, and q/t of each of its parts."""
    nu = plant.B.shape[2]
    filter_ = build_whitener(plant, noise, sampling_time)
    E = filter_(e)
    squares = float(np.mean(E**2))  # σ²
    log_likelihood = -0.5 * (E.size * np.log(squares) + filter_.log_determinant)
    if filter_.system is None:
        sensors = np.mean(E**2, axis=0) / squares
        return Shared(noise, float(log_likelihood), sensors, 1.0)
    x, r = transpose_filter(filter_.system, filter_.K, filter_.L, E)
    V, N = information(filter_.system, filter_.K, filter_.L)
    q, t = (np.sum(filter_.system.fresh * part[:, -nu:]) for part in (r**2 / squares, N))
    return Shared(
        noise=noise,
        log_likelihood=float(log_likelihood),
        sensors=np.sum(x**2, axis=0) / squares / V.sum(axis=0),
        inputs=float(q / t),
    )


def _moved(now: Shared, power: float, kinds: Sequence[Hashable], nu: int) -> Noise:
    """Returns the noise after a step, its shares of the mean square 1 again."""
    noise, ny = now.noise, len(now.sensors)
    variances = noise.of_outputs(ny) ** 2 * now.sensors**power
    for kind in dict.fromkeys(kinds):
        chosen = np.array([k == kind for k in kinds])
        least = LEAST_SHARE**2 * variances[chosen].mean()
        variances[chosen] = np.maximum(variances[chosen], least)
    scale = variances.mean()
    outputs = tuple(np.sqrt(variances / scale).tolist()) if ny > 1 else ()
    of_inputs = noise.of_inputs(nu) ** 2 * now.inputs**power / scale
    if not of_inputs.any():
        return replace(noise, outputs=outputs)
    return replace(noise, ratio=float(np.sqrt(of_inputs.mean())), outputs=outputs)
