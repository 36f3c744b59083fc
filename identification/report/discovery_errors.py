"""The errors of a discovery of a free run by the outputs' units, beside the noise."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot, isfinite

from identification.discovery.effect_results import Gap
from identification.discovery.result import Discovery
from identification.logs.by_unit import relative
from identification.report.error_words import error_words


def errors_of(gap: Gap, found: Discovery) -> Mapping[str, float]:
    """Returns the rms of a gap by the outputs' units, each in its unit."""
    several = len(gap.rms_by_unit) > 1
    return gap.rms_by_unit if several else {found.log.output_unit: gap.rms}


def sensors(found: Discovery) -> Mapping[str, float]:
    """Returns the rms of the sensors' noise by the outputs' units, each in its unit."""
    several = len(found.noise_by_unit) > 1
    return found.noise_by_unit if several else {found.log.output_unit: found.noise_rms}


def floor_rms(found: Discovery) -> float:
    """Returns the rms that sensors and unlogged input errors make of the true model's free run.

    It is over all outputs. Input errors count where they can be believed to be noise: where the
    model is believed, and where they are no larger than `allowed_input_error`.
    """
    return hypot(found.noise_rms, found.disturbance_rms if _is_believed(found) else 0.0)


def floor(found: Discovery) -> Mapping[str, float]:
    """Returns the rms of `floor_rms` by the outputs' units, each in its unit."""
    if len(found.noise_by_unit) < 2:
        return {found.log.output_unit: floor_rms(found)}
    disturbed = found.disturbance_by_unit if _is_believed(found) else {}
    return {unit: hypot(s, disturbed.get(unit, 0.0)) for unit, s in found.noise_by_unit.items()}


def times_noise(gap: Gap, found: Discovery) -> float:
    """Returns a gap relative to the noise, in one number; infinite where there is no noise."""
    return relative(errors_of(gap, found), floor(found))


def closed_share(found: Discovery) -> float | None:
    """Returns the share of power above the noise that named effects close; None without such."""
    before, after = (times_noise(gap, found) ** 2 for gap in (found.before, found.after))
    if not isfinite(before):
        of = [errors_of(gap, found) for gap in (found.after, found.before)]
        return min(1.0, max(0.0, 1 - relative(*of) ** 2)) if found.before.rms > 0 else None
    return min(1.0, max(0.0, (before - after) / (before - 1))) if before > 1 else None


def off(gap: Gap, found: Discovery) -> str:
    """Returns in words how far a model is off: 1.2 mrad rms off, or by unit."""
    return f"{error_words([errors_of(gap, found)])[0]} off"


def _is_believed(found: Discovery) -> bool:
    """Returns whether errors of the inputs pass for noise."""
    is_small = found.final.relative_input_error <= found.options.allowed_input_error
    return found.verdict != "unknown effect" and is_small
