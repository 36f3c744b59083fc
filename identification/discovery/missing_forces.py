"""Where the nominal model fails along a free run, and which forces would make it right.

    M δv̇ = … + r w,    w: a first-order process of the level that makes the residual most likely

r scales each force by how much it moves the outputs, so that newtons and newton metres compare. One
group of degrees of freedom is taken at a time: the actuated joints, or a free body. Each group may
explain all of the residual. Where few outputs are measured, forces at another place have nearly the
same effect, and only the law of an effect tells the place.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from identification.discovery.findings.evidence import (
    ForceEvidence,
    MedianFrequency,
    WorstInterval,
    WorstOutput,
)
from identification.discovery.findings.finding import Finding, FindingKind
from identification.kalman.linear import LinearPlant, linearise
from identification.kalman.noise_fit import START_CORRELATION_TIME, compute_unit_ratio, fit_noise
from identification.kalman.noise_model import smooth
from identification.kalman.refit import Refit
from identification.logs.noise import noise_floor
from identification.runtime.pool import one_blas_thread

# Of the power of a missing force: the regressor that it follows is reported from this share on.
TOLD_REGRESSOR_SHARE = 0.1
ERROR_INTERVALS = 10  # into which the fitted samples are divided, to tell when the error is worst
SIGN_STEEPNESS = 3.0  # of the sign of a rate, smoothed by tanh, per std of the rate
NEAR_ZERO_WIDTH = 0.3  # width of "near zero", in std of the rate
AXES = ("x", "y", "z")
FREE, SLIDE = int(mujoco.mjtJoint.mjJNT_FREE), int(mujoco.mjtJoint.mjJNT_SLIDE)


@dataclass(frozen=True, kw_only=True)
class MissingForce:
    """Forces on some degrees of freedom that would explain a residual."""

    where: str  # "the actuated joints", or the name of a free body
    names: tuple[str, ...]  # of the degrees of freedom, k of them
    units: tuple[str, ...]  # N or N m, k of them
    force: np.ndarray  # the smoothed estimate over the fitted samples, shape (N, k), in their units
    gain: float  # twice the log likelihood that they add to a model without them
    share: float  # of the residual's mean square that they explain, 0 to 1


def estimate_missing_forces(fit: Refit) -> tuple[MissingForce, ...]:
    """Returns the missing forces of every group of degrees of freedom.

    Args:
        fit: the nominal model, fitted.

    Raises:
        DivergenceError: the model cannot be simulated.
    """
    point = fit.point
    groups = _groups(point.predictor.plant.model)
    dofs = [d for _, of, _, _ in groups for d in of]
    plant = linearise(point.predictor, point.space.decode(point.q), forces=dofs)
    Ts, time, out, done = point.log.sampling_time, START_CORRELATION_TIME, [], 0
    known = point.e, point.J, fit.priors.weight, Ts
    with one_blas_thread():
        sensors = fit.level.noise.outputs
        none = fit_noise(plant, *known, levels=(0.0,), fine=False, outputs=sensors)
        for where, of, names, units in groups:
            B = plant.B[:, :, done : done + len(of)]
            done += len(of)
            if not B.any():
                continue
            each = [compute_unit_ratio(LinearPlant(plant.A, b[:, :, None], plant.C), Ts, time)
                    for b in np.moveaxis(B, 2, 0)]  # fmt: skip
            mine = LinearPlant(plant.A, B * each, plant.C)
            level = fit_noise(mine, *known, fine=False, outputs=sensors)
            force, part = smooth(mine, level.noise, point.e, Ts)
            out.append(
                MissingForce(
                    where=where,
                    names=names,
                    units=units,
                    force=force * each,
                    gain=2 * (level.log_likelihood - none.log_likelihood),
                    share=1 - float(np.mean((point.e - part) ** 2) / np.mean(point.e**2)),
                )
            )
    return tuple(out)


def list_actuated_joints(model: mujoco.MjModel) -> dict[int, int]:
    """Returns joints (not free) on which actuators act directly, and the first actuator of each."""
    transmission = int(mujoco.mjtTrn.mjTRN_JOINT)
    out: dict[int, int] = {}
    for i in range(model.nu):
        joint = int(model.actuator_trnid[i, 0])
        if model.actuator_trntype[i] == transmission and model.jnt_type[joint] != FREE:
            out.setdefault(joint, i)
    return out


def _groups(
    model: mujoco.MjModel,
) -> list[tuple[str, list[int], tuple[str, ...], tuple[str, ...]]]:
    """Returns name, degrees of freedom, their names and units: joints first, then free bodies."""
    joints = [*list_actuated_joints(model)]
    out = []
    if joints:
        out.append((
            "the actuated joints",
            [int(model.jnt_dofadr[j]) for j in joints],
            tuple(model.joint(j).name for j in joints),
            tuple("N" if model.jnt_type[j] == SLIDE else "N m" for j in joints),
        ))  # fmt: skip
    for j in np.flatnonzero(model.jnt_type == FREE):
        first = int(model.jnt_dofadr[j])
        names = tuple(f"{kind} {axis}" for kind in ("force", "torque") for axis in AXES)
        body = model.body(int(model.jnt_bodyid[j])).name
        out.append((body, list(range(first, first + 6)), names, ("N",) * 3 + ("N m",) * 3))
    return out


def locate_error(fit: Refit, forces: Sequence[MissingForce]) -> tuple[Finding, ...]:
    """Returns findings on where the nominal model fails on the fitted samples.

    Args:
        fit: the nominal model, fitted.
        forces: the forces that it lacks.
    """
    return (
        Finding(FindingKind.WORST_OUTPUT, _worst_output(fit)),
        Finding(FindingKind.WORST_INTERVAL, _worst_interval(fit)),
        Finding(FindingKind.MEDIAN_FREQUENCY, _median_frequency(fit)),
        *(Finding(FindingKind.MISSING_FORCE, _summarise(fit, f)) for f in forces),
    )


def _worst_output(fit: Refit) -> WorstOutput:
    log, e = fit.point.log, fit.point.e
    rms = np.sqrt(np.mean(e**2, axis=0))
    scale, noise = np.ones(len(rms)), fit.level.of_outputs(len(rms))
    if len({log.units.get(n, "") for n in log.output_names}) > 1:
        # Errors of unlike outputs compare relative to the outputs' own motion.
        scale, noise = np.std(log.outputs, axis=0), noise_floor(log.outputs)
    share = (rms / np.where(scale > 0, scale, np.inf)) ** 2
    worst = int(share.argmax())
    name = log.output_names[worst]
    return WorstOutput(
        output=name,
        unit=log.units.get(name, ""),
        rms=float(rms[worst]),
        share=float(share[worst] / np.sum(share)),
        noise_ratio=float(rms[worst] / noise[worst]),
    )


def _worst_interval(fit: Refit) -> WorstInterval:
    log, e = fit.point.log, fit.point.e
    starts = np.linspace(0, len(e), ERROR_INTERVALS, endpoint=False).astype(int)
    energy = np.add.reduceat(np.sum(e**2, axis=1), starts)
    late, span = int(energy.argmax()), log.duration / ERROR_INTERVALS
    return WorstInterval(late * span, (late + 1) * span, float(energy[late] / energy.sum()))


def _median_frequency(fit: Refit) -> MedianFrequency:
    e = fit.point.e
    spectrum = np.sum(np.abs(np.fft.rfft(e - e.mean(axis=0), axis=0)) ** 2, axis=1)
    f = np.fft.rfftfreq(len(e), fit.point.log.sampling_time)
    half = f[int(np.searchsorted(np.cumsum(spectrum), 0.5 * spectrum.sum()))]
    return MedianFrequency(float(max(half, f[1])))


def _summarise(fit: Refit, force: MissingForce) -> ForceEvidence:
    units, rms = tuple(dict.fromkeys(force.units)), []
    for unit in units:
        mine = [u == unit for u in force.units]
        rms.append(float(np.sqrt(np.mean(force.force[:, mine] ** 2))))
    shares = explain_force(fit, force.force)
    best = max(shares, key=shares.__getitem__)
    return ForceEvidence(
        where=force.where,
        units=units,
        rms=tuple(rms),
        share=force.share,
        regressor=best if shares[best] >= TOLD_REGRESSOR_SHARE else None,
        regressor_share=shares[best],
    )


def list_regressors(fit: Refit) -> dict[str, np.ndarray]:
    """Returns regressors that a missing force may follow, by name: shape (N, ny) or (N, 1) each.

    Rates and positions are among them where there are as many outputs as inputs: each output is
    then taken for the position on which the input of the same index acts.
    """
    log = fit.point.log
    y = log.outputs - fit.point.e
    rate = np.gradient(y, log.sampling_time, axis=0)
    u = log.inputs
    out = {"time": log.time[:, None] - log.time.mean(), "input": u}
    if u.shape[1] == y.shape[1]:
        scale = rate.std(axis=0) + 1e-300
        out |= {
            "rate sign": np.tanh(SIGN_STEEPNESS * rate / scale),
            "rate": rate,
            "rate size": np.abs(rate),
            "rate near zero": rate * np.exp(-((rate / (NEAR_ZERO_WIDTH * scale)) ** 2)),
            "rate squared": rate * np.abs(rate),
            "position": y,
        }
    return out


def explain_force(fit: Refit, force: np.ndarray) -> Mapping[str, float]:
    """Returns the share of a force's power (N, k) that follows each regressor, 0 to 1 each."""
    w = force - force.mean(axis=0)
    power = np.sum(w**2) + 1e-300
    out = {}
    for name, r in list_regressors(fit).items():
        if r.shape[1] in (1, w.shape[1]):
            r = np.broadcast_to(r - r.mean(axis=0), w.shape)
            along = np.sum(r * w, axis=0) ** 2 / (np.sum(r**2, axis=0) + 1e-300)
            out[name] = float(np.sum(along) / power)
    return out
