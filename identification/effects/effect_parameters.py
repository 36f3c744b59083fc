"""The parameters of an effect: each size at each place, zero; each shape once."""

from __future__ import annotations

from identification.effects.effect import Effect, Shape, Size
from identification.model.parameter import Parameter


def effect_parameters(effect: Effect) -> tuple[Parameter, ...]:
    """Returns records of `effect.size` + suffix at all places of an effect, and `effect.shape`."""
    sizes = [
        _size(effect.parameter(size.name, where), size)
        for size in effect.sizes
        for where in effect.places
    ]
    return (*sizes, *(_shape(f"{effect.name}.{shape.name}", shape) for shape in effect.shapes))


def _size(name: str, size: Size) -> Parameter:
    lower = -size.farthest if size.sign <= 0 else 0.0
    upper = size.farthest if size.sign >= 0 else 0.0
    return Parameter(
        name=name,
        value=0.0,
        unit=size.unit,
        where="effect",
        lower=lower,
        upper=upper,
        symbol=size.name,
        about=size.about,
        scale=size.probe,
    )


def _shape(name: str, shape: Shape) -> Parameter:
    return Parameter(
        name=name,
        value=shape.at_first,
        unit=shape.unit,
        where="effect",
        lower=shape.lower,
        upper=shape.upper,
        symbol=shape.name,
        about=shape.about,
    )
