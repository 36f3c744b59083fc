"""The places where nominal model and log disagree: output, time, frequency and force.

What a missing force follows is told by the share of its power that one regressor explains.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from identification.discovery.findings.evidence import (
    ForceEvidence,
    MedianFrequency,
    WorstInterval,
    WorstOutput,
)
from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.missing_forces import MissingForce
from identification.kalman.refit import Refit
from identification.logs.noise import noise_floor

# Of the power of a missing force: the regressor that it follows is reported from this share on.
TOLD_REGRESSOR_SHARE = 0.1
ERROR_INTERVALS = 10  # into which the fitted samples are divided, to tell when the error is worst
SIGN_STEEPNESS = 3.0  # of the sign of a rate, smoothed by tanh, per std of the rate
NEAR_ZERO_WIDTH = 0.3  # width of "near zero", in std of the rate


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
    scale, noise = np.ones(len(rms)), np.full(len(rms), fit.level.sigma)
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
