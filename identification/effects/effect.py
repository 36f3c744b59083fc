"""A candidate effect: parameters of a plant that are zero in the nominal model, and their physics.

An effect is a group of sizes, all zero where it is absent, and of shapes, which say how it looks
when it is there (a Stribeck velocity, a harmonic). Its sizes enter the model linearly, or nearly
so; its shapes do not matter while the sizes are zero, so they are tried on a grid and freed once
the effect is named.

What it adds to the law of a robot is said by its hooks: each is one njit function of the state of
what it acts on and of the tuple of its parameters, sizes first. With sizes of zero it adds nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import KW_ONLY, dataclass, field, replace
from functools import cached_property
from inspect import signature
from typing import Any

from identification.effects.sizes import Onset, Shape, Size
from identification.errors import InputError
from identification.model.parameter import Parameter

# hook, and the state of a joint that it needs
STATES = {"series": "motor", "slip": "grip", "integral": "sum"}
CURVE = "curve"  # names of effects that begin so are curves drawn from the data


@dataclass(frozen=True)
class Effect:
    """An effect that may be missing from a model.

    Attributes:
        name: canonical name.
        law: the equation, as a reader writes it.
        sizes: zero when the effect is absent.
        shapes: see `Shape`.
        places: where it may act, in words, each with its parameters' suffix: {"all drives": "",
            "drive 1": "@1"}; parameters are called `effect.size` + suffix.
        joints: of places that are sensors, the joint that each measures: {"sensor tip": "joint
            elbow"}; empty for other places.
        phrase: "{where}: " follows; e.g. "friction: Stribeck peak".
        reference: table, paper or book of the law.
        probes: multiples of the sizes' probes at which its sensitivity is taken, where the outputs
            follow its size only nearly in proportion; below zero the other way.
        needs: name of an effect that it changes, and without which it has no meaning: a level of
            friction that differs by direction needs a level. Searches over a horizon ask for it.
        shares: whether its own state is one with that of every other effect that has the same rate,
            which then reads no parameter: what happens to a thing whichever effect looks at it.
        own: whether its size is each record's own, such as a shift of that record's time stamps;
            one record cannot tell it from what is the same in all.
        of_records: the effect in words where each record has a size of its own, as the zero of an
            encoder has that is set before each record; "" where that is no candidate. It is then
            told and no name (`in_each_record`).
        is_among: whether it is felt only beside things on which it does not act, so that it never
            acts at all of its places: sensors that are all late are inputs that come late.
        onset: where what it adds is multiplied by a course in time, that course.
        hooks: where it adds to the law of a robot, e.g. "force", and the njit function (state,
            parameters) that says what. None are needed where its sizes are paths into a model.

    Raises:
        InputError: a hook's function is not compiled by numba, or does not take two arguments.
    """

    name: str
    law: str
    sizes: tuple[Size, ...]
    shapes: tuple[Shape, ...] = ()
    _: KW_ONLY
    places: Mapping[str, str] = field(default_factory=dict, hash=False)
    joints: Mapping[str, str] = field(default_factory=dict, hash=False)
    phrase: str = ""
    reference: str = ""
    probes: tuple[float, ...] = (1.0,)
    needs: str = ""
    shares: bool = False
    own: bool = False
    of_records: str = ""
    is_among: bool = False
    onset: Onset | None = None
    hooks: Mapping[str, Callable[..., Any]] = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        for hook, function in self.hooks.items():
            _refuse_unfit(self.name, hook, function)

    @property
    def is_curve(self) -> bool:
        """Tells whether it is no law but a curve drawn from the data."""
        return self.name.startswith(CURVE)

    @property
    def is_of_records(self) -> bool:
        """Tells whether it is a difference between records, which is told and is no name."""
        return self.own and bool(self.of_records)

    @property
    def state(self) -> str:
        """The kind of joint state that it needs: "motor", "grip" or "sum"; most often none, ""."""
        return next((kind for hook, kind in STATES.items() if hook in self.hooks), "")

    @property
    def names(self) -> tuple[str, ...]:
        """Its parameters in the order in which the hooks get them: sizes, then shapes."""
        return (*(size.name for size in self.sizes), *(shape.name for shape in self.shapes))

    @property
    def about(self) -> dict[str, str]:
        """What each of its parameters is, in words, by name."""
        return {
            **{size.name: size.about for size in self.sizes},
            **{shape.name: shape.about for shape in self.shapes},
        }

    def parameter(self, name: str, where: str) -> str:
        """Returns the plant's parameter name of a size at a place, or of a shape (one for all)."""
        if any(shape.name == name for shape in self.shapes):
            return f"{self.name}.{name}"
        return f"{self.name}.{name}{self.places[where]}"

    @cached_property
    def every_size(self) -> tuple[str, ...]:
        """Names of the plant's parameters for all its sizes at all its places."""
        return tuple(self.parameter(size.name, at) for at in self.places for size in self.sizes)

    def parameters_at(self, thing: str) -> tuple[tuple[str, ...], ...]:
        """Returns names of the plant's parameters that add up to each of its numbers at one thing.

        Args:
            thing: name of a joint, drive or input, as it stands behind the @ of a place.

        Returns:
            A tuple for each of `names`; none where the effect cannot act on the thing.
        """
        if thing not in self._parameters:  # a search asks a million times
            self._parameters[thing] = self._parameters_at(thing)
        return self._parameters[thing]

    @cached_property
    def _parameters(self) -> dict[str, tuple[tuple[str, ...], ...]]:
        return {}

    def _parameters_at(self, thing: str) -> tuple[tuple[str, ...], ...]:
        single = [suffix for suffix in self.places.values() if suffix]
        if single and f"@{thing}" not in single:
            return ()
        suffixes = [s for s in self.places.values() if s in ("", f"@{thing}")]
        sizes = (tuple(f"{self.name}.{size.name}{at}" for at in suffixes) for size in self.sizes)
        return (*sizes, *((f"{self.name}.{shape.name}",) for shape in self.shapes))


def _refuse_unfit(effect: str, hook: str, function: Any) -> None:
    where = f"effect {effect!r}: the function of its hook {hook!r}"
    law = getattr(function, "py_func", None)
    if law is None:
        raise InputError(f"{where} is not compiled; write @njit of numba above it")
    taken = tuple(signature(law).parameters)
    if len(taken) != 2:
        raise InputError(
            f"{where} takes ({', '.join(taken)}); it must take two arguments, the state of what it"
            " acts on and the tuple of the effect's parameters"
        )


@dataclass(frozen=True)
class Candidate:
    """An effect at a place with shapes chosen: what a score is computed for.

    Attributes:
        effect: which.
        where: at which of its places.
        shape: values of its shapes by name, in their units.
        probe: multiple of its sizes' probes, one of the effect's.
    """

    effect: Effect
    where: str
    shape: Mapping[str, float]
    probe: float = 1.0

    @property
    def key(self) -> tuple[str, str]:
        """Its effect and its place, whatever its shapes."""
        return self.effect.name, self.where

    @property
    def sizes(self) -> tuple[str, ...]:
        """The plant's parameters that are zero without it."""
        return tuple(self.effect.parameter(s.name, self.where) for s in self.effect.sizes)

    @property
    def free(self) -> tuple[str, ...]:
        """The sizes that are estimated, by the names of the plant's parameters."""
        sizes = zip(self.sizes, self.effect.sizes, strict=True)
        return tuple(name for name, size in sizes if size.present is None)

    @property
    def estimated(self) -> tuple[str, ...]:
        """The plant's parameters that a fit with it estimates: free sizes, and free shapes."""
        shapes = (self.effect.parameter(s.name, self.where) for s in self.effect.shapes if s.free)
        return (*self.free, *shapes)

    @property
    def whole(self) -> dict[str, float]:
        """Values of the sizes that can have only one value."""
        sizes = zip(self.sizes, self.effect.sizes, strict=True)
        return {name: size.present for name, size in sizes if size.present is not None}

    @property
    def fixed(self) -> dict[str, float]:
        """Values of the plant's shape parameters."""
        return {self.effect.parameter(n, self.where): v for n, v in self.shape.items()}


def effect_parameters(effect: Effect) -> tuple[Parameter, ...]:
    """Returns records of `effect.size` + suffix at all places of an effect, and `effect.shape`."""
    sizes = (
        Parameter(
            name=effect.parameter(size.name, where), value=0.0, unit=size.unit, where="effect",
            lower=-size.farthest if size.sign <= 0 else 0.0,
            upper=size.farthest if size.sign >= 0 else 0.0,
            symbol=size.name, about=size.about, scale=size.probe,
        )
        for size in effect.sizes for where in effect.places
    )  # fmt: skip
    shapes = (
        Parameter(
            name=f"{effect.name}.{shape.name}", value=shape.at_first, unit=shape.unit,
            where="effect", lower=shape.lower, upper=shape.upper, symbol=shape.name,
            about=shape.about,
        )
        for shape in effect.shapes
    )  # fmt: skip
    return (*sizes, *shapes)


BY_RECORD = " by record"  # behind a place, in words


def in_each_record(effect: Effect) -> Effect:
    """Returns an effect with a size for each record, at single places: another way to free it."""
    single = {where + BY_RECORD: suffix for where, suffix in effect.places.items() if suffix}
    return replace(effect, own=True, phrase=effect.of_records, places=single)


def places(kind: str, names: tuple[str, ...]) -> dict[str, str]:
    """Returns the places of an effect, in words, with the suffix of their parameters' names.

    Args:
        kind: of the things, e.g. "joint".
        names: of the things; where there are several, the effect may act on all alike, or on one.
    """
    each = {f"{kind} {name}": f"@{name}" for name in names}
    return each if len(names) < 2 else {f"all {kind}s": "", **each}
