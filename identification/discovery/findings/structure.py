"""Structure that a fitted model leaves unexplained on the fitted samples, beyond chance.

The innovations of the fitted samples are tested; those of the unseen samples contain the error of
the parameters as well, which is not random.
"""

from __future__ import annotations

from identification.discovery.findings.evidence import (
    CorrelatedInnovations,
    LargeInputError,
    NoisyOutput,
    ParametersAtLimit,
    SpectralLine,
)
from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.fitted_model import FittedModel, list_parameters_at_limit
from identification.discovery.options import DiscoveryOptions
from identification.estimation.residuals import innovation_tests


def find_structure(model: FittedModel, options: DiscoveryOptions) -> tuple[Finding, ...]:
    """Returns what a model does not explain on the fitted samples; empty when it explains all.

    Args:
        model: the fitted model.
        options: what counts as beyond chance, and as an error of the inputs that is no noise.
    """
    log = model.refit.point.log
    white = innovation_tests(model.innovations, log.sampling_time)
    out = []
    if white.p_line < options.structure_level:
        line = SpectralLine(log.output_names[white.channel], white.frequency, white.p_line)
        out.append(Finding(FindingKind.SPECTRAL_LINE, line))
    if white.p_louder < options.structure_level:
        noisy = NoisyOutput(log.output_names[white.loudest], white.p_louder)
        out.append(Finding(FindingKind.NOISY_OUTPUT, noisy))
    if white.is_correlated(options.structure_level, options.min_structure_share):
        correlated = CorrelatedInnovations(white.predictable, white.p_correlation)
        out.append(Finding(FindingKind.CORRELATED_INNOVATIONS, correlated))
    if names := list_parameters_at_limit(model):
        out.append(Finding(FindingKind.PARAMETERS_AT_LIMIT, ParametersAtLimit(names)))
    if model.refit.relative_input_error > options.allowed_input_error:
        out.append(Finding(FindingKind.LARGE_INPUT_ERROR, _input_error(model)))
    return tuple(out)


def _input_error(model: FittedModel) -> LargeInputError:
    log, level = model.refit.point.log, model.refit.level
    return LargeInputError(
        unit=log.units.get(log.input_names[0], ""),
        rms=level.input_std,
        share=model.refit.relative_input_error,
        correlation_time=level.noise.time,
    )
