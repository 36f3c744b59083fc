"""Any MJCF as a plant with candidate effects on its joints, bodies, inputs and sensors.

`identification.effects.plant.jointed` says what such a plant does; here one is made of a model
file.

Inside MuJoCo a function of an effect cannot raise, and a NaN that it returns is found much later,
as a simulation that diverged. So each function of a user's own for joints is called in plain Python
at a few states before anything is simulated with it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import product
from math import isfinite
from pathlib import Path

import mujoco
import numpy as np

from identification.effects.axes import Axis, axes
from identification.effects.catalogue import all_effects
from identification.effects.effect import Effect, effect_parameters
from identification.effects.plant.jointed import JointPlant as JointPlant
from identification.effects.plant.rows import JointLayout, read_model, with_rows
from identification.effects.values import terms_of
from identification.errors import InputError, unknown_name
from identification.logs.log import Log
from identification.model.parameter import Parameter, ParameterSet
from identification.model.plant import ModelPlant
from identification.model.rollout import State
from identification.native.element import Hook, refuse_unfit_functions
from identification.native.input_filter import INPUT
from identification.native.joints.joint_callback import JOINT, Joint

VALUES = (0.0, 0.3, -0.7)  # of position and rate: at rest, and in both directions


def joint_plant(
    source: str | Path | mujoco.MjSpec,
    parameters: Iterable[Parameter],
    log: Log,
    *,
    joints: Sequence[Axis] | None = None,
    effects: Sequence[Effect] | None = None,
    own_effects: Sequence[Effect] = (),
    start: State | None = None,
) -> JointPlant:
    """Compile an MJCF whose joints and inputs may have effects.

    Args:
        source: path of an MJCF file, or its text, or the result of `read_model`.
        parameters: its own, with paths; those called as an effect's are that effect's.
        log: shows how far joints and inputs move, which says what sizes are plausible.
        joints: the joints that may have effects; those that the log measures when None.
        effects: the candidates; all of the catalogue when None.
        own_effects: candidates beside them, of the caller's own.
        start: the initial state; the model's own when None.

    Raises:
        InputError: the model or a path is unusable, a joint does not move in the log, or an effect
            has a hook that is none of a joint, an input, a body or a sensor; or an own effect has a
            place that is not there, or a function that fails when it is tried.
    """
    spec = read_model(source)
    known = tuple(joints) if joints is not None else axes(spec.copy().compile(), log)
    if effects is None:
        effects = all_effects(spec, known, log)
    effects = (*effects, *own_effects)
    records = {p.name: p for e in effects for p in effect_parameters(e)}
    given = {p.name: p for p in parameters}
    paths = ParameterSet("own", tuple(p for p in given.values() if p.name not in records))
    every = (*paths, *(given.get(name, record) for name, record in records.items()))
    layout = JointLayout(effects)
    if own_effects:
        inputs = [actuator.name for actuator in spec.actuators]
        refuse_unfit_own(own_effects, [a.joint for a in known], inputs)
    bare = ModelPlant(with_rows(spec, known, layout), paths, start)
    name = spec.modelname or "robot"
    plant = JointPlant(
        bare, ParameterSet(name, every), effects, tuple(a.joint for a in known),
        spec=spec, axes=known,
    )  # fmt: skip
    return plant.with_states_of(n for n in given if n in records)


def candidates(plant: JointPlant, names: Iterable[str]) -> tuple[Effect, ...]:
    """Returns the effects of a plant that may be missing: those without a free parameter.

    Args:
        plant: of `joint_plant`.
        names: its free parameters.
    """
    free = {name.partition(".")[0] for name in names}
    return tuple(e for e in plant.effects if e.name not in free)


def refuse_unfit_own(
    effects: Sequence[Effect], joints: Sequence[str], actuators: Sequence[str]
) -> None:
    """Refuse own effects at a place that is not there, or with functions that fail."""
    for element, things in ((JOINT, joints), (INPUT, actuators)):
        fitting = [e for e in effects if {h.name for h in element.hooks} & {*e.hooks}]
        for effect in fitting:
            for place in filter(None, effect.places.values()):
                if place.removeprefix("@") not in things:
                    what = f"{element.name} of effect {effect.name!r}:"
                    raise unknown_name(what, place.removeprefix("@"), things)
        refuse_unfit_functions(element, terms_of(fitting, element))
    for effect in effects:
        for hook in JOINT.hooks:
            if hook.name in effect.hooks:
                _try(effect, hook)


def _try(effect: Effect, hook: Hook) -> None:
    """Calls a function of a joint in plain Python, at rest and in motion."""
    law = effect.hooks[hook.name].py_func  # type: ignore[attr-defined]
    where = f"effect {effect.name!r}: the function {law.__name__} of its hook {hook.name!r}"
    let = f"let it return {hook}, finite in every state"
    p = (*(float(size.probe) for size in effect.sizes), *(float(s.at_first) for s in effect.shapes))
    for q, v, sign in product(VALUES, VALUES, (-1.0, 1.0)):
        s = Joint(time=0.5, q=q, v=v, f_u=0.2, f_g=-0.1, sign=sign)
        at = f"at {', '.join(f'{k} = {x:g}' for k, x in s._asdict().items())} and {p}"
        try:
            with np.errstate(all="ignore"):
                value = law(s, p)
        except Exception as error:  # whatever the user's own lines raise
            reason = f"{type(error).__name__}: {error}".rstrip(": ")
            raise InputError(f"{where} raises {reason} {at}; {let}") from error
        if value is None or isinstance(value, complex) or not isfinite(value):
            raise InputError(f"{where} returns {value} {at}; {let}")
