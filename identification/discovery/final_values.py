"""The numbers that a discovery ends with."""

from __future__ import annotations

from identification.discovery.result import Discovery
from identification.kalman.refit import Refit


def final_values(found: Discovery) -> dict[str, float]:
    """Values of all parameters of the final fit, those of the named effects included."""
    at = found.final.point
    out = {**at.predictor.plant.parameters.values(), **at.values}
    for named in found.named:
        effect, where = named.candidate.effect, named.candidate.where
        shapes = {shape.name for shape in effect.shapes}
        for name, (value, _, _) in named.parameters.items():
            # one shape serves all places
            key = f"{effect.name}.{name}" if name in shapes else effect.parameter(name, where)
            out[key] = value
    return out


def std_of(fit: Refit) -> dict[str, float]:
    """Std of the values of a fit's free parameters, in their units."""
    space = fit.point.space
    std = fit.std * space.slope(fit.point.q)
    return dict(zip(space.names, std.tolist(), strict=True))
