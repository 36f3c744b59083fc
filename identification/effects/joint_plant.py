"""Any MJCF as a plant with candidate effects on its joints, bodies, inputs and sensors.

`identification.effects.jointed` says what such a plant does; here one is made of a model file.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import mujoco

from identification.effects.axes import Axis, axes
from identification.effects.catalogue import all_effects
from identification.effects.effect import Effect
from identification.effects.effect_parameters import effect_parameters
from identification.effects.joint_layout import JointLayout
from identification.effects.jointed import JointPlant as JointPlant
from identification.effects.own_effects import refuse_unfit_own
from identification.effects.rows import read_model, with_rows
from identification.logs.log import Log
from identification.model.parameter import Parameter, ParameterSet
from identification.model.plant import ModelPlant
from identification.model.rollout import State


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
