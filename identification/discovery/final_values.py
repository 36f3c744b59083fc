"""The values with which a discovery ends."""

from __future__ import annotations

from identification.discovery.result import Discovery
from identification.kalman.refit import Refit


def collect_final_values(found: Discovery) -> dict[str, float]:
    """Values of all parameters of the final fit by name, those of the named effects included."""
    point = found.final.point
    out = {**point.predictor.plant.parameters.values(), **point.values}
    for named in found.named:
        effect, where = named.candidate.effect, named.candidate.where
        shapes = {shape.name for shape in effect.shapes}
        for name, (value, _, _) in named.parameters.items():
            # A shape is one parameter for all places.
            key = f"{effect.name}.{name}" if name in shapes else effect.parameter(name, where)
            out[key] = value
    return out


def collect_std(fit: Refit) -> dict[str, float]:
    """Std of the free parameters of a fit by name, in their units."""
    space = fit.point.space
    std = fit.std * space.slope(fit.point.q)
    return dict(zip(space.names, std.tolist(), strict=True))
