"""The evidence of a finding about one log: its numbers and names, and no sentences."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from identification.discovery.effect_results import RejectedEffect, Scored


@dataclass(frozen=True)
class WorstOutput:
    """The output with the largest error of the nominal model on the fitted samples."""

    output: str  # its name
    unit: str  # its unit
    rms: float  # of its error [unit]
    share: float  # of the mean square over all outputs, 0 to 1
    noise_ratio: float  # rms over the std of the sensors' noise


@dataclass(frozen=True)
class WorstInterval:
    """The tenth of the fitted samples with the largest error of the nominal model."""

    start: float  # of the interval, from the first sample [s]
    end: float  # of the interval, from the first sample [s]
    share: float  # of the mean square over all fitted samples, 0 to 1


@dataclass(frozen=True)
class MedianFrequency:
    """The frequency below which half of the power of the error lies."""

    frequency: float  # [Hz]


@dataclass(frozen=True, kw_only=True)
class ForceEvidence:
    """Generalised forces that would explain the error of the nominal model."""

    where: str  # on which degrees of freedom
    units: tuple[str, ...]  # N, N m, or both
    rms: tuple[float, ...]  # of the forces of each unit, in that unit
    share: float  # of the residual's mean square that they explain, 0 to 1
    # what the forces follow, a key of `location.list_regressors`; None when they follow none by
    # enough
    regressor: str | None
    regressor_share: float  # of their power that follows the best regressor, 0 to 1


@dataclass(frozen=True)
class InputHold:
    """Inputs that explain the log far better when they are held otherwise between samples."""

    hold: str  # the other hold, "foh" or "zoh"
    unit: str  # of the inputs
    rms: float  # of the inputs' error with the other hold [unit]
    rms_now: float  # of the inputs' error with the hold of the log [unit]


@dataclass(frozen=True)
class SpectralLine:
    """A line in the spectrum of the innovations."""

    output: str  # name of the output on which it has the most power
    frequency: float  # [Hz]
    p_value: float  # of the test that there is none


@dataclass(frozen=True)
class CorrelatedInnovations:
    """Innovations that are not white."""

    share: float  # of their power that follows from the samples before, 0 to 1
    p_value: float  # of the test that they are white


@dataclass(frozen=True)
class ParametersAtLimit:
    """Parameters of the nominal model at the end of what is plausible."""

    parameters: tuple[str, ...]  # their names


@dataclass(frozen=True)
class LargeInputError:
    """Inputs that would have to err by more than passes for noise."""

    unit: str  # of the inputs
    rms: float  # of their error [unit]
    share: float  # rms over the inputs' own motion
    correlation_time: float  # of the error [s]


@dataclass(frozen=True)
class RobotChange:
    """Unseen samples that the model predicts worse than the fitted ones."""

    ratio: float  # of the rms of the innovations, unseen over fitted
    time: float  # from which on [s]


@dataclass(frozen=True)
class UnexpectedError:
    """An error of the free run on unseen samples that noise and std do not make."""

    ratio: float  # of its rms to that which they make


@dataclass(frozen=True)
class StructuredInputError:
    """An unlogged error of the inputs that follows something that was logged."""

    regressor: str  # what it follows, a key of `input_error.list_families`
    input: str  # name of the input with the largest error
    unit: str  # of that input
    rms: float  # of the error over all inputs [unit]
    fall: float  # share of the unseen mean square that it explains, 0 to 1


@dataclass(frozen=True)
class DoubtfulEffect:
    """The best effect that fitted samples want and unseen ones do not prove."""

    rejected: RejectedEffect  # the effect as it was refitted


@dataclass(frozen=True)
class UntriedEffect:
    """The best effect whose score is beyond chance, and that the time limit left unfitted."""

    score: Scored  # of the effect


@dataclass(frozen=True)
class OversizedEffect:
    """An effect that explains more than what is named, but at a size beyond belief."""

    score: Scored  # of the effect
    # the largest size that is believed, by name of each size that exceeds it
    limits: Mapping[str, float]
