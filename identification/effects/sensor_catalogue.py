"""Candidate effects of a robot's sensors; their laws are in `sensor_laws`.

What is plausible: a scale off by 5 % (a wrong gear ratio or count is a matter of units), a zero off
by a tenth of the travel, a disc off its centre by a hundredth of its radius or two, 20 ms of lag.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import mujoco

from identification.effects import sensor_laws as laws
from identification.effects.axes import Axis, Kind
from identification.effects.effect import Effect, Shape, Size
from identification.effects.kinds import prefix_of, with_kind
from identification.effects.places import places
from identification.native.element import Function

SCALE = 0.05
OFFSET = 0.1  # of the travel
ECCENTRICITY = 0.02  # [rad]
LAG = 0.02  # [s]
PROBE = 0.02  # of the largest plausible size
LAGS = "q through a first-order lag τ, or q(t - τ)"
KIND = Shape("kind", "", (0.0, 1.0), 0.0, 1.0, free=False, usual=0.0, about="0 a lag, 1 a delay")


def sensor_effects(
    model: mujoco.MjModel, outputs: Sequence[str], axes: Sequence[Axis]
) -> tuple[Effect, ...]:
    """Returns all candidates of some sensors.

    Lag, offset and eccentricity are those of positions. Where a robot has hinges and slides, the
    names of the effects of slides' sensors begin with `slide_`, but for what has no unit.

    Args:
        model: with the sensors.
        outputs: names of the sensors.
        axes: the joints; sensors of others are passed over.
    """
    known = {a.joint: a for a in axes}
    joints = {n: known[j] for n in outputs if (j := measured_joint(model, n)) in known}
    positions = {n: a for n, a in joints.items() if _is_position(model, n)}
    out = [_effect(laws.encoder_scale, "(1 + s) y", (_size("s", "", SCALE, "relative"),),
                   (*joints,), "sensor: scale")]  # fmt: skip
    kinds: list[Kind] = ["hinge", "slide"]
    both = {a.kind for a in positions.values()} == {*kinds}
    for kind in kinds:
        own = {n: a for n, a in positions.items() if a.kind == kind}
        if own:
            made = [*_of_positions(own, kind), *([_lag(own)] if len(outputs) > 1 else [])]
            out += [
                replace(e, name=prefix_of(kind, both) + e.name,
                        phrase=with_kind(e.phrase, kind, both))
                for e in made
            ]  # fmt: skip
    return tuple(e for e in out if e.places)


def measured_joint(model: mujoco.MjModel, output: str) -> str:
    """Returns the name of the joint that a jointpos or jointvel sensor measures."""
    return str(model.joint(int(model.sensor(output).objid[0])).name)


def _is_position(model: mujoco.MjModel, output: str) -> bool:
    return int(model.sensor(output).type[0]) == int(mujoco.mjtSensor.mjSENS_JOINTPOS)


def _of_positions(own: dict[str, Axis], kind: Kind) -> list[Effect]:
    x, names = ("rad" if kind == "hinge" else "m"), (*own,)
    far = OFFSET * max(a.travel for a in own.values())
    out = [
        _effect(laws.encoder_offset, "y + c", (_size("c", x, far, "of its zero"),), names,
                "sensor: zero is displaced"),
    ]  # fmt: skip
    if kind == "hinge":
        waves = (_size("a", x, ECCENTRICITY, "of the cosine"),
                 _size("b", x, ECCENTRICITY, "of the sine"))  # fmt: skip
        out.append(_effect(laws.encoder_eccentricity, "y + a cos q + b sin q", waves, names,
                           "sensor: its disc is off centre"))  # fmt: skip
    return out


def _lag(own: dict[str, Axis]) -> Effect:
    sizes = (_size("tau", "s", LAG, "lag behind the other sensors"),)
    made = _effect(laws.encoder_lag, LAGS, sizes, (*own,), "sensor: lags")
    some = {where: at for where, at in made.places.items() if at}
    return replace(made, shapes=(KIND,), places=some)


def _size(name: str, unit: str, largest: float, about: str) -> Size:
    return Size(name, unit, largest, PROBE * largest, 0, about)


def _effect(
    law: Function, said: str, sizes: tuple[Size, ...], names: tuple[str, ...],
    phrase: str,
) -> Effect:  # fmt: skip
    return Effect(
        law.__name__, said, sizes, places=places("sensor", names), phrase=phrase,
        hooks={"reading": law},
    )  # fmt: skip
