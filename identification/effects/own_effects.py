"""Effects of a user's own, tried once before anything is simulated with them.

Inside MuJoCo a function of an effect cannot raise, and a NaN that it returns is found much later,
as a simulation that diverged. So each function of a joint is called in plain Python at a few
states.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from math import isfinite
from typing import Any

import numpy as np

from identification.effects.effect import Effect
from identification.effects.layout import terms_of
from identification.errors import InputError, unknown_name
from identification.native.element import Element
from identification.native.hook_checks import refuse_unfit_functions
from identification.native.input_filter import INPUT
from identification.native.joint_callback import JOINT, Joint

VALUES = (0.0, 0.3, -0.7)  # of position and rate: at rest, and in both directions


def refuse_unfit_own(
    effects: Sequence[Effect], joints: Sequence[str], actuators: Sequence[str]
) -> None:
    """Refuse own effects at a place that is not there, or with functions that fail.

    Args:
        effects: of the user's own.
        joints: names of the joints that may have effects.
        actuators: names of the inputs.

    Raises:
        InputError: a place is unknown, or a function cannot be compiled, may return nothing,
            raises, or returns a number that is not finite.
    """
    for element, things in ((JOINT, joints), (INPUT, actuators)):
        own = [e for e in effects if {h.name for h in element.hooks} & {*e.hooks}]
        for effect in own:
            for suffix in effect.places.values():
                if suffix and suffix.removeprefix("@") not in things:
                    raise unknown_name(f"{element.name} of effect {effect.name!r}:",
                                       suffix.removeprefix("@"), things)  # fmt: skip
        refuse_unfit_functions(element, terms_of(own, element))
    for effect in effects:
        for name, function in effect.hooks.items():
            if name in {hook.name for hook in JOINT.hooks}:
                _try(effect, JOINT, name, function.py_func)  # type: ignore[attr-defined]


def _try(effect: Effect, element: Element, hook: str, law: Any) -> None:
    """Call a function of a joint at rest and in motion."""
    where = f"effect {effect.name!r}: the function {law.__name__} of its hook {hook!r}"
    shapes = [_usual(s.grid, s.usual) for s in effect.shapes]
    p = tuple(float(x) for x in (*(size.probe for size in effect.sizes), *shapes))
    for q, v, sign in product(VALUES, VALUES, (-1.0, 1.0)):
        s = Joint(time=0.5, q=q, v=v, f_u=0.2, f_g=-0.1, sign=sign)
        at = f"at {', '.join(f'{k} = {x:g}' for k, x in s._asdict().items())} and {p}"
        try:
            with np.errstate(all="ignore"):
                value = law(s, p)
        except Exception as error:  # whatever the user's own lines raise
            reason = f"{type(error).__name__}: {error}".rstrip(": ")
            raise InputError(f"{where} raises {reason} {at}; let it return {_what(element, hook)}"
                             ) from error  # fmt: skip
        if value is None or isinstance(value, complex) or not isfinite(value):
            raise InputError(f"{where} returns {value} {at}; let it return {_what(element, hook)}")


def _what(element: Element, hook: str) -> str:
    return f"{element.hook(hook)}, finite in every state"


def _usual(grid: Sequence[float], usual: float | None) -> float:
    return usual if usual is not None else grid[len(grid) // 2]
