"""The common scale of errors of outputs of several units, in a sentence."""

from __future__ import annotations

from identification.prediction.model import WindowModel
from identification.quantities import quantity


def describe_scale(model: WindowModel) -> list[str]:
    """Returns a sentence on what a mean square over unlike outputs is; none for outputs alike.

    Args:
        model: fitted; its scale is the rms error of each output under the nominal model.
    """
    log = model.fit.problem.parts[0].predictor.log
    units = [log.units.get(name, "") for name in log.output_names]
    if len(set(units)) == 1:
        return []
    each = ", ".join(
        f"{quantity(float(s), unit=unit)} of {name}"
        for name, s, unit in zip(log.output_names, model.scale, units, strict=True)
    )
    return [
        "A mean square over outputs of several units counts the error of each output in multiples"
        f" of its rms error under the fitted nominal model: {each}."
    ]
