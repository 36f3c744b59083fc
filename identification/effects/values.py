"""Parameters of a set of effects: their places in rows, and their values at things.

    row of a thing = (…, parameters of effect 1, parameters of effect 2, …)
    a thing gets    size(all) + size@thing          shapes are the same for all

Sizes come first, shapes follow. The key of a set says which compiled law its rows are made for.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from zlib import crc32

import numpy as np

from identification.effects.effect import Effect
from identification.errors import InputError
from identification.native.element import Element, Term
from identification.native.input_filter import INPUT, input_filter
from identification.native.reading import SENSOR, sensor_filter

Values = Mapping[str, float | np.ndarray]  # by name of the parameter, one or n of each


def terms_of(
    effects: Sequence[Effect], element: Element, *, first: int = 0, state_hook: str = ""
) -> tuple[Term, ...]:
    """Returns the effects of one element, and where in its row their parameters stand.

    Columns are counted from `first`; effects with `state_hook` have a state of their own.
    """
    out: list[Term] = []
    column, states = first, _states(effects, state_hook)
    for effect in effects:
        if not _acts_on(effect, element):
            continue
        out.append(
            Term(
                effect=effect.name,
                functions=tuple(effect.hooks.items()),
                names=effect.names,
                sizes=len(effect.sizes),
                column=column,
                state=states.get(effect.name, 0),
            )
        )
        column += len(effect.names)
    return tuple(out)


def _states(effects: Sequence[Effect], hook: str) -> dict[str, int]:
    """Returns the number of each effect's state, counted from 1, by the effect's name."""
    numbers: dict[object, int] = {}
    having = [e for e in effects if hook in e.hooks]
    keys = {e.name: e.hooks[hook] if e.shares else e.name for e in having}
    return {name: numbers.setdefault(key, len(numbers) + 1) for name, key in keys.items()}


def key_of(effects: Sequence[Effect], of: str = "") -> float:
    """Returns the number that tells a set of effects from others, `of` what they act on."""
    return float(crc32((of + repr([(e.name, e.names, e.law) for e in effects])).encode()))


def refuse_misplaced(effects: Sequence[Effect], elements: Sequence[Element]) -> None:
    """Refuse effects that a robot cannot have."""
    names = [e.name for e in effects]
    twice = sorted({n for n in names if names.count(n) > 1})
    if twice:
        raise InputError(f"two effects are called {twice[0]!r}; rename one")
    for effect in effects:
        if sum(_acts_on(effect, element) for element in elements) != 1:
            hooks = f"the hooks {', '.join(effect.hooks)}" if effect.hooks else "no hook"
            known = "; ".join(
                f"{element.name}: {', '.join(hook.name for hook in element.hooks)}"
                for element in elements
            )
            raise InputError(
                f"effect {effect.name!r} has {hooks}; give it hooks of one of the things that this"
                f" robot has ({known})"
            )


def _acts_on(effect: Effect, element: Element) -> bool:
    return bool(effect.hooks) and effect.hooks.keys() <= {hook.name for hook in element.hooks}


def merged(own: Mapping[str, float], names: Sequence[str], values: np.ndarray) -> Values:
    """Returns a plant's own values of all parameters with others of p, shape (n, p)."""
    return {**own, **dict(zip(names, values.T, strict=True))}


def numbers_at(effect: Effect, thing: str, values: Values) -> list[float | np.ndarray]:
    """Returns sizes and shapes of an effect at one thing; zeros where it cannot act on it."""
    parts = effect.parameters_at(thing)
    return [sum(values[name] for name in some) for some in parts] or [0.0] * len(effect.names)


def written_at(effect: Effect, thing: str, values: Values) -> list[float | np.ndarray]:
    """Returns sizes and shapes of an effect as they stand in the row of a thing.

    Where the effect is absent its shapes do not matter, and stay what they are at first: what is
    put at one thing moves no number of another.
    """
    numbers, n = numbers_at(effect, thing, values), len(effect.sizes)
    is_there = np.any(np.broadcast_arrays(*numbers[:n]), axis=0)
    shapes = zip(numbers[n:], effect.shapes, strict=True)
    return [*numbers[:n], *(np.where(is_there, x, shape.at_first) for x, shape in shapes)]


def table_at(effects: Sequence[Effect], thing: str, values: Values, n: int) -> np.ndarray:
    """Returns the rows of some effects at one thing for n value sets, shape (n, columns)."""
    columns = [x for e in effects for x in numbers_at(e, thing, values)]
    return np.array([np.broadcast_to(x, n) for x in columns]).reshape(len(columns), n).T.copy()


def is_present(effect: Effect, things: Sequence[str], values: Values) -> bool:
    """Returns whether any size of an effect is not zero at any of some things."""
    sizes = len(effect.sizes)
    each = [
        [values[name] for name in names]
        for thing in things
        for names in effect.parameters_at(thing)[:sizes]
    ]
    # Most effects are absent: numbers that are all zero are told from others before they are added.
    return any(_is_some(sum(x)) for x in each if any(v.__class__ is not float or v for v in x))


def _is_some(x: float | np.ndarray) -> bool:
    return bool(x.any()) if isinstance(x, np.ndarray) else x != 0.0


def changed_columns(
    effects: Sequence[Effect], terms: Sequence[Term], thing: str, names: Sequence[str],
    values: Values,
) -> Iterator[tuple[int, float | np.ndarray]]:  # fmt: skip
    """Yields the entries of a thing's row that some parameters change: column, and its values."""
    by_name, touched = {e.name: e for e in effects}, set(names)
    for term in terms:
        effect = by_name[term.effect]
        numbers = written_at(effect, thing, values)
        for k, parts in enumerate(effect.parameters_at(thing)):
            if touched & set(parts):
                yield term.column + k, numbers[k]


def changed_inputs(
    effects: Sequence[Effect], things: Sequence[str], values: Values, held: np.ndarray,
    timestep: float, n: int, begun: float = 0.0,
) -> np.ndarray:  # fmt: skip
    """Returns the inputs after the effects that act on them, for n value sets.

    Args:
        effects: a set; those that act on other things are passed over.
        things: names of the inputs.
        values: of all parameters, one or n of each.
        held: inputs at the steps of the simulation, shape (steps, nu).
        timestep: of the simulation [s].
        n: how many value sets.
        begun: time of the first step in the record [s].

    Returns:
        `held` itself where no such effect is there, else shape (n, steps, nu).
    """
    acting, where = _acting(effects, "input", things, values)
    if not where:
        return held
    run = input_filter(terms_of(acting, INPUT))
    out = np.repeat(held[None], n, axis=0)
    signals = np.empty((1 + len(acting), len(held)))
    for i in where:
        for k, row in enumerate(table_at(acting, things[i], values, n)):
            signals[0] = held[:, i]
            run(signals.ctypes.data, len(held), timestep, begun, row.ctypes.data)
            out[k, :, i] = signals[-1]
    return out


def changed_outputs(
    effects: Sequence[Effect], things: Sequence[str], values: Values, readings: np.ndarray, n: int
) -> np.ndarray:
    """Returns the readings of sensors after the effects that act on them, for n value sets.

    Args:
        effects: a set; those that act on other things are passed over.
        things: names of the ny sensors.
        values: of all parameters, one or n of each.
        readings: y, q, v and time of each sensor, shape (4, m, samples, ny); each value set has
            m/n neighbouring rows.
        n: how many value sets.

    Returns:
        y itself where no such effect is there, else shape (m, samples, ny).
    """
    y = np.asarray(readings[0])
    acting, where = _acting(effects, "reading", things, values)
    if not where:
        return y
    run, y = sensor_filter(terms_of(acting, SENSOR)), y.copy()
    signals = np.empty((len(y) // n, 5, y.shape[1]))
    first, apart = signals.ctypes.data, signals.strides[0]
    for i in where:
        for k, row in enumerate(table_at(acting, things[i], values, n)):
            columns = slice(k * len(signals), (k + 1) * len(signals))
            signals[:, :4] = np.moveaxis(readings[:, columns, :, i], 0, 1)
            for one in range(len(signals)):  # an effect may read earlier samples of the same row
                run(first + one * apart, y.shape[1], row.ctypes.data)
            y[columns, :, i] = signals[:, 4]
    return y


def _acting(
    effects: Sequence[Effect], hook: str, things: Sequence[str], values: Values
) -> tuple[list[Effect], list[int]]:
    """Returns the effects with a hook, and the indices of the things at which one is present."""
    acting = [e for e in effects if hook in e.hooks]
    present = [any(is_present(e, [thing], values) for e in acting) for thing in things]
    return acting, [i for i, is_there in enumerate(present) if is_there]
