"""The values with which a discovery ends."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from identification.discovery.result import Discovery
from identification.effects.effect import Effect
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


def keep_of_robot(values: Mapping[str, float], effects: Sequence[Effect]) -> dict[str, float]:
    """The values of a robot that hold in every log.

    Args:
        values: values by name.
        effects: the effects that the robot may have; shapes that tell something of one log (what
            an input did before its first sample) are left out.
    """
    of_log = {f"{e.name}.{s.name}" for e in effects for s in e.shapes if s.of_log}
    return {name: value for name, value in values.items() if name not in of_log}


def collect_std(fit: Refit) -> dict[str, float]:
    """Std of the free parameters of a fit by name, in their units."""
    space = fit.point.space
    std = fit.std * space.slope(fit.point.q)
    return dict(zip(space.names, std.tolist(), strict=True))
