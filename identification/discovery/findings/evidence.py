"""The evidence of a finding about one log: its numbers and names, and no sentences."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from identification.discovery.effect_results import RejectedEffect, Scored


@dataclass(frozen=True)
class WorstOutput:
    """The output with the largest error of the nominal model on the fitted samples.

    Attributes:
        output: its name.
        unit: its unit.
        rms: of its error [unit].
        share: of the mean square over all outputs, 0 to 1.
        noise_ratio: rms over the std of the sensors' noise.
    """

    output: str
    unit: str
    rms: float
    share: float
    noise_ratio: float


@dataclass(frozen=True)
class WorstInterval:
    """The tenth of the fitted samples with the largest error of the nominal model.

    Attributes:
        start: of the interval, from the first sample [s].
        end: of the interval, from the first sample [s].
        share: of the mean square over all fitted samples, 0 to 1.
    """

    start: float
    end: float
    share: float


@dataclass(frozen=True)
class MedianFrequency:
    """The frequency below which half of the power of the error lies.

    Attributes:
        frequency: [Hz].
    """

    frequency: float


@dataclass(frozen=True, kw_only=True)
class ForceEvidence:
    """Generalised forces that would explain the error of the nominal model.

    Attributes:
        where: on which degrees of freedom.
        units: N, N m, or both.
        rms: of the forces of each unit, in that unit.
        share: of the residual's mean square that they explain, 0 to 1.
        regressor: what the forces follow, a key of `location.list_regressors`; None when they
            follow none by enough.
        regressor_share: of their power that follows the best regressor, 0 to 1.
    """

    where: str
    units: tuple[str, ...]
    rms: tuple[float, ...]
    share: float
    regressor: str | None
    regressor_share: float


@dataclass(frozen=True)
class InputHold:
    """Inputs that explain the log far better when they are held otherwise between samples.

    Attributes:
        hold: the other hold, "foh" or "zoh".
        unit: of the inputs.
        rms: of the inputs' error with the other hold [unit].
        rms_now: of the inputs' error with the hold of the log [unit].
    """

    hold: str
    unit: str
    rms: float
    rms_now: float


@dataclass(frozen=True)
class SpectralLine:
    """A line in the spectrum of the innovations.

    Attributes:
        output: name of the output on which it has the most power.
        frequency: [Hz].
        p_value: of the test that there is none.
    """

    output: str
    frequency: float
    p_value: float


@dataclass(frozen=True)
class CorrelatedInnovations:
    """Innovations that are not white.

    Attributes:
        share: of their power that follows from the samples before, 0 to 1.
        p_value: of the test that they are white.
    """

    share: float
    p_value: float


@dataclass(frozen=True)
class ParametersAtLimit:
    """Parameters of the nominal model at the end of what is plausible.

    Attributes:
        parameters: their names.
    """

    parameters: tuple[str, ...]


@dataclass(frozen=True)
class LargeInputError:
    """Inputs that would have to err by more than passes for noise.

    Attributes:
        unit: of the inputs.
        rms: of their error [unit].
        share: rms over the inputs' own motion.
        correlation_time: of the error [s].
    """

    unit: str
    rms: float
    share: float
    correlation_time: float


@dataclass(frozen=True)
class RobotChange:
    """Unseen samples that the model predicts worse than the fitted ones.

    Attributes:
        ratio: of the rms of the innovations, unseen over fitted.
        time: from which on [s].
    """

    ratio: float
    time: float


@dataclass(frozen=True)
class StructuredInputError:
    """An unlogged error of the inputs that follows something that was logged.

    Attributes:
        regressor: what it follows, a key of `input_error.list_families`.
        input: name of the input with the largest error.
        unit: of that input.
        rms: of the error over all inputs [unit].
        fall: share of the unseen mean square that it explains, 0 to 1.
    """

    regressor: str
    input: str
    unit: str
    rms: float
    fall: float


@dataclass(frozen=True)
class DoubtfulEffect:
    """The best effect that fitted samples want and unseen ones do not prove.

    Attributes:
        rejected: the effect as it was refitted.
    """

    rejected: RejectedEffect


@dataclass(frozen=True)
class OversizedEffect:
    """An effect that explains more than what is named, but at a size beyond belief.

    Attributes:
        score: of the effect.
        limits: the largest size that is believed, by name of each size that exceeds it.
    """

    score: Scored
    limits: Mapping[str, float]
