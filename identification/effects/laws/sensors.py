"""Errors that an encoder may add to its reading y of a joint at position q with rate v.

    scale           s y                     its counts are not what they are taken for
    offset          c                       its zero is not the joint's
    eccentricity    a cos q + b sin q       its disc turns about another centre
    lag             x - q, τ ẋ = q - x      kind 0: it is filtered
                    q(t - τ) - q            kind 1: it is read or sent too late
    jump            c where t ≥ t_s         counts are lost: a ramp that takes the time w

A lag is never negative, because no sensor knows the future, and it is felt only beside sensors that
are not late: what all of them have in common is a shift of the inputs. What is plausible: a scale
off by 5 % (a wrong gear ratio or count is a matter of units), a zero off by a tenth of the travel,
a disc off its centre by a hundredth of its radius or two, 20 ms of lag. Each function takes the
state of a sensor (`identification.native.reading.Reading`) and the effect's parameters, sizes
first.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import cos, pi, sin
from typing import Any

import mujoco
from numba import njit

from identification.effects.axes import Axis, Kind
from identification.effects.effect import Effect, places
from identification.effects.laws.joint_group import prefix_of, with_kind
from identification.effects.sizes import Shape, Sign, Size
from identification.native.element import Function
from identification.native.reading import lagged_position, position_at

SCALE = 0.05
OFFSET = 0.1  # of the travel
ECCENTRICITY = 0.02  # [rad]
# Of a turn of a hinge, below which its disc is not asked: there the cosine and the sine are nearly
# a zero and a scale by other numbers, and with a bend of any size they draw a part of any smooth
# error. In 540 worlds of small robots that hid no such disc, six had its name, of joints that moved
# by less (rows of benchmarks/results/robot_models.jsonl before 55c3deda).
LEAST_TURN = 0.5
LAG = 0.02  # [s]
PROBE = 0.02  # of the largest plausible size
KIND = Shape("kind", "", (0.0, 1.0), 0.0, 1.0, free=False, usual=0.0, about="0 a lag, 1 a delay",
             words=("it is a lag", "it is a delay"))  # fmt: skip


@njit
def encoder_scale(s, p):
    return p[0] * s.y


@njit
def encoder_offset(s, p):
    return p[0]


@njit
def encoder_eccentricity(s, p):
    return p[0] * cos(s.q) + p[1] * sin(s.q)


@njit
def encoder_lag(s, p):
    tau, kind = p
    if kind == 0.0:
        return lagged_position(s, tau) - s.q
    return position_at(s, s.time - tau) - s.q


@njit
def encoder_jump(s, p):
    return p[0] * min(1.0, max(0.0, 0.5 + (s.time - p[1]) / p[2]))


def sensor_effects(
    model: mujoco.MjModel, outputs: Sequence[str], axes: Sequence[Axis], asked: Sequence[str] = ()
) -> tuple[Effect, ...]:
    """Returns all candidates of some sensors.

    Lag, offset and eccentricity are those of positions. Where a robot has hinges and slides, the
    names of the effects of slides' sensors begin with `slide_`, but for what has no unit. A single
    output has no lag: it has no other that it could be late against.

    Args:
        model: with the sensors.
        outputs: their names.
        axes: the joints.
        asked: names of effects that are candidates however little a joint moves.
    """
    known = {a.joint: a for a in axes}
    joints = {n: known[j] for n in outputs if (j := measured_joint(model, n)) in known}
    positions = {n: a for n, a in joints.items() if _is_position(model, n)}
    out = [_effect(encoder_scale, "(1 + s) y", "sensor: scale", joints,
                   _size("s", "", SCALE, "relative"))]  # fmt: skip
    kinds: list[Kind] = ["hinge", "slide"]
    both = {a.kind for a in positions.values()} == {*kinds}
    for kind in kinds:
        of_kind = {n: a for n, a in positions.items() if a.kind == kind}
        for e in _of_positions(of_kind, kind, len(outputs), asked) if of_kind else ():
            phrase = with_kind(e.phrase, kind, both)
            out.append(replace(e, name=prefix_of(kind, both) + e.name, phrase=phrase))
    return tuple(e for e in out if e.places)


def measured_joint(model: mujoco.MjModel, output: str) -> str:
    """Returns the name of the joint that a jointpos or jointvel sensor measures."""
    return str(model.joint(int(model.sensor(output).objid[0])).name)


def _is_position(model: mujoco.MjModel, output: str) -> bool:
    return int(model.sensor(output).type[0]) == int(mujoco.mjtSensor.mjSENS_JOINTPOS)


def _of_positions(
    sensors: dict[str, Axis], kind: Kind, outputs: int, asked: Sequence[str]
) -> list[Effect]:
    x = "rad" if kind == "hinge" else "m"
    far = OFFSET * max(a.travel for a in sensors.values())
    out = [_effect(encoder_offset, "y + c", "sensor: zero is displaced", sensors,
                   _size("c", x, far, "of its zero"),
                   of_records="sensor: its zero differs between the records")]  # fmt: skip
    least = 0.0 if "encoder_eccentricity" in asked else LEAST_TURN * 2 * pi
    turned = {n: a for n, a in sensors.items() if a.travel >= least}
    if kind == "hinge" and turned:
        out.append(_effect(encoder_eccentricity, "y + a cos q + b sin q",
                           "sensor: its disc is off centre", turned,
                           _size("a", x, ECCENTRICITY, "of the cosine"),
                           _size("b", x, ECCENTRICITY, "of the sine")))  # fmt: skip
    if outputs > 1:
        lag = _effect(encoder_lag, "q through a first-order lag τ, or q(t - τ)", "sensor: lags",
                      sensors, _size("tau", "s", LAG, "lag behind the other sensors", 1),
                      shapes=(KIND,), is_among=outputs == len(sensors))  # fmt: skip
        out.append(replace(lag, places={where: at for where, at in lag.places.items() if at}))
    return out


def _size(name: str, unit: str, largest: float, about: str, sign: Sign = 0) -> Size:
    return Size(name, unit, largest, PROBE * largest, sign, about)


def _effect(
    law: Function, said: str, phrase: str, sensors: dict[str, Axis], *sizes: Size, **more: Any
) -> Effect:
    joints = {f"sensor {name}": f"joint {axis.joint}" for name, axis in sensors.items()}
    return Effect(law.__name__, said, sizes, places=places("sensor", (*sensors,)), phrase=phrase,
                  joints=joints, hooks={"reading": law}, **more)  # fmt: skip
