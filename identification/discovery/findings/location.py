"""Where model and log disagree: which output, when, at which frequency, along with what.

What a missing force goes along with is told by the share of its power that one regressor explains.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from identification.discovery.fitted_model import FittedModel, is_relevant
from identification.discovery.missing_forces import MissingForce
from identification.discovery.result import Tried
from identification.kalman.innovations import SURE, innovation_tests
from identification.kalman.noise_fit import ALLOWED
from identification.kalman.refit import Refit
from identification.quantities import probability, quantity
from identification.report.discovery_words import phrase, sizes

TELLING = 0.1  # share of a missing force that is worth a sentence
BELIEVED = 1.0  # the same, above which the log's inputs are not what moved the robot


def regressors(fit: Refit) -> dict[str, np.ndarray]:
    """What a missing force may go along with, by name: shape (N, ny) each, or (N, 1)."""
    log = fit.point.log
    y = log.outputs - fit.point.e
    rate = np.gradient(y, log.sampling_time, axis=0)
    u = log.inputs
    same = u.shape[1] == y.shape[1]
    out = {"time": log.time[:, None] - log.time.mean()}
    out["its input"] = u
    if same:
        scale = rate.std(axis=0) + 1e-300
        out |= {
            "the sign of its rate": np.tanh(3 * rate / scale),
            "its rate": rate,
            "the size of its rate": np.abs(rate),
            "its rate near zero": rate * np.exp(-((rate / (0.3 * scale)) ** 2)),
            "the square of its rate": rate * np.abs(rate),
            "its angle": y,
        }
    return out


def shares(fit: Refit, force: np.ndarray) -> Mapping[str, float]:
    """Share of a force's power (N, k) that goes along with each regressor, 0 to 1 each."""
    w = force - force.mean(axis=0)
    power = np.sum(w**2) + 1e-300
    out = {}
    for name, r in regressors(fit).items():
        if r.shape[1] in (1, w.shape[1]):
            r = np.broadcast_to(r - r.mean(axis=0), w.shape)
            along = np.sum(r * w, axis=0) ** 2 / (np.sum(r**2, axis=0) + 1e-300)
            out[name] = float(np.sum(along) / power)
    return out


def located(nominal: FittedModel, missing: Sequence[MissingForce]) -> tuple[str, ...]:
    """Where the nominal model fails on the fitted samples, in sentences."""
    fit = nominal.refit
    log, e = fit.point.log, fit.point.e
    out = []
    rms = np.sqrt(np.mean(e**2, axis=0))
    worst = int(rms.argmax())
    share = rms[worst] ** 2 / np.sum(rms**2)
    name = log.output_names[worst]
    unit = log.units.get(name, "")
    out.append(
        "of the fitted samples the error is largest on"
        f" {name}: {quantity(rms[worst], unit=unit)} rms, {100 * share:.0f} % of all,"
        f" {rms[worst] / fit.level.sigma:.1f} times the sensors' noise"
    )
    energy = np.add.reduceat(
        np.sum(e**2, axis=1), np.linspace(0, len(e), 10, endpoint=False).astype(int)
    )
    late = int(energy.argmax())
    span = log.duration / 10
    out.append(
        f"it is largest from {late * span:.1f} to {(late + 1) * span:.1f} s"
        f" ({100 * energy[late] / energy.sum():.0f} % of it)"
    )
    spectrum = np.sum(np.abs(np.fft.rfft(e - e.mean(axis=0), axis=0)) ** 2, axis=1)
    f = np.fft.rfftfreq(len(e), log.sampling_time)
    half = f[int(np.searchsorted(np.cumsum(spectrum), 0.5 * spectrum.sum()))]
    out.append(f"half of it lies below {max(half, f[1]):.2g} Hz")
    return (*out, *(_acting(fit, m) for m in missing))


def _acting(fit: Refit, missing: MissingForce) -> str:
    """A missing force, its size, its share, and what it goes along with."""
    sizes = []
    for unit in dict.fromkeys(missing.units):
        mine = [u == unit for u in missing.units]
        sizes.append(f"{np.sqrt(np.mean(missing.force[:, mine] ** 2)):.2g} {unit}")
    said = (
        f"generalised forces of {' and '.join(sizes)} rms on {missing.where} would explain"
        f" {100 * missing.share:.0f} % of it"
    )
    found = shares(fit, missing.force)
    best = max(found, key=found.__getitem__)
    if found[best] >= TELLING:
        said += f"; {100 * found[best]:.0f} % of their power goes along with {best}"
    return said


def find_structure(step: FittedModel) -> tuple[str, ...]:
    """What the final model does not explain, in sentences; empty when it explains all."""
    log = step.refit.point.log
    white = innovation_tests(step.innovations, log.sampling_time)
    out = []
    if white.p_line < SURE:
        out.append(
            f"a line at {white.frequency:.2f} Hz on {log.output_names[white.channel]} that no"
            f" candidate explains (chance {probability(white.p_line)})"
        )
    if white.p_louder < SURE:
        out.append(
            f"{log.output_names[white.loudest]} is noisier than the others"
            f" (chance {probability(white.p_louder)})"
        )
    if white.correlated:
        out.append(
            f"innovations that are not white: {100 * white.predictable:.0f} % of their power"
            f" follows from the samples before (chance {probability(white.p_correlation)})"
        )
    if step.stretched:
        out.append(
            f"{' and '.join(step.stretched)} at the end of what is plausible, by the nominal"
            " values that were given"
        )
    if (err := input_error(step.refit)) > ALLOWED:
        level = step.refit.level
        unit = log.units.get(log.input_names[0], "")
        out.append(
            f"inputs that would have to err by {quantity(level.input_std, unit=unit)} rms beside"
            f" what the log says, {100 * err:.0f} % of their own motion, for"
            f" {level.noise.time:.2g} s at a time"
        )
    return tuple(out)


def find_doubtful_effect(rejected: Sequence[Tried]) -> tuple[str, ...]:
    """The likeliest effect that fitted samples want and that would matter, but is not proven."""
    wanted = [t for t in rejected if t.gain > 0 and is_relevant(t.proof)]
    return tuple(
        f"{phrase(t.candidate)}, {sizes(t)}, which explains the fitted samples beyond chance and"
        f" {100 * t.proof.fall:.0f} % of the error on unseen data, but not surely there"
        f" (t = {t.proof.t:.1f})"
        for t in wanted[:1]
    )


def believed(step: FittedModel) -> bool:
    """Whether a model may be named that leaves something: inputs and base parameters as given."""
    return input_error(step.refit) < BELIEVED and not step.stretched


def input_error(fit: Refit) -> float:
    """Error of the inputs that the noise model takes for granted, as a share of their motion."""
    moved = fit.point.motion
    return fit.level.input_std / moved if moved > 0 else 0.0
