"""In which scale errors count where outputs have several units, or none."""

from __future__ import annotations

from identification.prediction.model import WindowModel
from identification.quantities import quantity


def describe_scale(model: WindowModel, unit: str) -> list[str]:
    """A sentence that says what an error of 1 is; none where errors have a unit.

    Args:
        model: fitted; its scale is the rms error of each output under the nominal model.
        unit: of the errors, "" where they count in that scale.
    """
    if unit:
        return []
    log = model.fit.problem.parts[0].predictor.log
    each = ", ".join(
        f"{quantity(float(s), unit=log.units.get(name, ''))} of {name}"
        for name, s in zip(log.output_names, model.scale, strict=True)
    )
    return [
        "Errors count in the scale of each output, its rms error under the nominal model: 1 is"
        f" {each}."
    ]
