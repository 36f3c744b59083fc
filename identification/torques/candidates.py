"""What a model may lack, as columns of the equations of torques.

    law of a joint, force          -f(s) at the joint          of the catalogue, by its own hook
    law of a joint, friction       b(s) sign v at the joint
    curve of a joint               -f(x) at the joint, x: its rate, position, drive or the time
    ten numbers of a body          Y_b Δπ                      of the catalogue, by its own hook
    load at a body                 Y_b (M, h, I_O)             any place and inertia
    rotor inertia of a joint       a at the joint
    gain of an actuator            -τ̂_u, so that its force is (1 + γ) τ_u
    delay of one actuator          dτ_u/dt of what its input moves, far below the band's period
    gain drift of an actuator      t τ̂_u

τ̂_u is the drives' force as the base fit predicts it from the motion, and not the measured one: its
noise is that of the equations, and columns with it would explain noise by noise. Laws of the load
take τ̂_u for the same reason.

Each has a few sizes, and is linear in them. A shape of a law takes the values of its grid. Laws
with a state of their own, or of sensors, have no column here; `identification discover` has them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import mujoco
import numpy as np

from identification.effects.effect import Effect
from identification.effects.laws.bodies import HOOK
from identification.effects.laws.inputs import SHIFT
from identification.effects.moving_bodies import MovingBody
from identification.effects.plant.body_numbers import frame_inertia, seen
from identification.effects.variables import variables
from identification.torques.equations.base import independent_columns, reach_of
from identification.torques.equations.bodies import (
    NUMBERS,
    UNITS,
    label_of,
    list_bodies,
    read_numbers,
)
from identification.torques.equations.equations import Columns, Equations
from identification.torques.laws import CURVES, Laws, Missing, listed

GAIN = 0.5  # largest change of a gain, also of one that drifts
ROUNDING = 1e-9  # of the largest column
UNLIKE = 1e-3  # share of a column that is no sum of those before it, to have a size of its own
FORCES = {"force", "friction"}  # hooks of joints that need no state


def list_missing(
    model: mujoco.MjModel, equations: Equations, expected: np.ndarray, effects: Sequence[Effect],
    bodies: Sequence[MovingBody], free: Sequence[str],
) -> tuple[Missing, ...]:  # fmt: skip
    """Returns all candidates.

    `expected` is τ̂_u, shape (N, nv) [N m or N], `effects` those of the catalogue that the user asks
    for, and `free` paths of numbers that are fitted already.
    """
    laws = Laws(model, equations, expected)
    out: list[Missing] = []
    for effect in effects:
        is_of_neighbour = effect.is_curve and not effect.name.endswith(tuple(CURVES))
        is_of_servo = "e" in variables(effect)  # whose setpoint these equations do not have
        if {*effect.hooks} <= FORCES and effect.hooks and not (is_of_neighbour or is_of_servo):
            out += laws.of(effect)
        elif {*effect.hooks} == {HOOK} and not effect.shapes:  # a load is linear here: see below
            out += [
                c for c in _of_bodies(model, equations, effect, bodies) if not _is_free(c, free)
            ]
    out += _loads(model, equations)
    out += [c for c in _rotors(model, equations) if not {*c.sizes} & {*free}]
    return (*out, *_of_drives(model, equations, expected))


def _is_free(missing: Missing, free: Sequence[str]) -> bool:
    """Returns whether a candidate of a body is a number of it that is fitted already."""
    number = {"mass_mismatch": ".mass", "inertia_mismatch": ".inertia", "com_offset": ".ipos"}
    path = missing.where + number.get(missing.name, ".none")
    return any(f.startswith(path.replace("body ", "body/", 1)) for f in free)


def _of_bodies(
    model: mujoco.MjModel, equations: Equations, effect: Effect, bodies: Sequence[MovingBody]
) -> Iterator[Missing]:
    """Yields an effect of bodies at each of its places."""
    roots = list_bodies(model)
    for where, suffix in effect.places.items():
        body = next(b for b in bodies if b.label == suffix[1:])
        if body.index in roots:
            i = roots.index(body.index)
            make = partial(_body_columns, model, equations, effect, body, i)
            yield listed(effect, where, {}, make)


def _body_columns(
    model: mujoco.MjModel, equations: Equations, effect: Effect, body: MovingBody, i: int
) -> Columns:
    b, law = body.index, effect.hooks[HOOK].py_func  # type: ignore[attr-defined]
    I_c = frame_inertia(model.body_inertia[b], model.body_iquat[b])
    state = seen(body.mass, np.array(model.body_ipos[b]), I_c, body.point)
    Y = equations.stacked("bodies")[:, :, i]
    each = []
    for k, size in enumerate(effect.sizes):  # they are linear, or nearly so near zero
        probes = [
            tuple(s * size.probe * (n == k) for n in range(len(effect.sizes))) for s in (1, -1)
        ]
        up, down = (np.array(law(state, p)) for p in probes)
        each.append(Y @ ((up - down) / (2 * size.probe)))
    return Columns(np.stack(each, axis=2))


def _loads(model: mujoco.MjModel, equations: Equations) -> Iterator[Missing]:
    """Yields a load of any place at each body, by the numbers that the joints feel apart."""
    mass, reach = float(read_numbers(model)[:, 0].sum()), reach_of(model)
    used = equations.stacked("used")[:, :, None]
    scale = mass * reach ** np.array([0, 1, 1, 1, *[2] * 6])
    bodies = equations.stacked("bodies")
    largest = float(np.linalg.norm(bodies * used[..., None], axis=(0, 1)).max())
    for i, b in enumerate(list_bodies(model)):
        Y = np.where(used, bodies[:, :, i], 0.0).reshape(-1, 10) * scale / mass
        felt = independent_columns(Y, ROUNDING * largest, UNLIKE).tolist()
        if felt:
            K = np.linalg.lstsq(Y[:, felt], Y, rcond=None)[0] * scale[felt][:, None] / scale
            yield Missing(
                name="load", where=f"body {label_of(model, b)}",
                phrase="body: a load at any place", sizes=tuple(NUMBERS[k] for k in felt),
                units=tuple(UNITS[k] for k in felt), signs=tuple(int(k == 0) for k in felt),
                columns=partial(_load_columns, bodies[:, :, i], felt),
                most=tuple(scale[felt].tolist()), of_body=(K, scale),
            )  # fmt: skip


def _load_columns(Y: np.ndarray, felt: list[int]) -> Columns:
    return Columns(Y[:, :, felt])


def _rotors(model: mujoco.MjModel, equations: Equations) -> Iterator[Missing]:
    """Yields another rotor inertia at each joint."""
    for j in range(model.nv):
        name = model.joint(int(model.dof_jntid[j])).name
        kind = int(model.jnt_type[model.dof_jntid[j]])
        unit = "kg" if kind == int(mujoco.mjtJoint.mjJNT_SLIDE) else "kg m^2"
        yield Missing(
            name="rotor_inertia", where=f"joint {name}", phrase="motor: another rotor inertia",
            sizes=(f"joint/{name}.armature",), units=(unit,), signs=(0,),
            columns=partial(_at_joints, equations.stacked("a"), [j]), most=(np.inf,),
        )  # fmt: skip


def _at_joints(x: np.ndarray, joints: Sequence[int]) -> Columns:
    out = np.zeros((*x.shape, 1))
    out[:, joints, 0] = x[:, joints]
    return Columns(out, tuple(joints))


def _of_drives(
    model: mujoco.MjModel, equations: Equations, expected: np.ndarray
) -> Iterator[Missing]:
    """Yields gains, delays and drifts of actuators that alone drive their joints, and of all."""
    acts = np.abs(equations.stacked("drives")).max(axis=0) > 0  # (nv, nu)
    alone = [
        i for i in range(model.nu) if acts[:, i].any() and (acts.sum(axis=1)[acts[:, i]] == 1).all()
    ]
    rate = equations.stacked("late")
    late = equations.stacked("time")[:, None] * expected
    lasts = max(float(r.time[-1]) for r in equations.rows)
    groups = [(f"input {model.actuator(i).name}", [i]) for i in alone]
    together = [("all inputs", alone)] if len(alone) > 1 else []
    for name, phrase, size, unit, most, force, where in (
        # all gains together are the masses of everything
        ("gain", "input: another gain", "gamma", "", GAIN, -expected, groups),
        ("delay", "input: comes late", "tau", "s", SHIFT, rate, groups),
        ("gain_drift", "input: gain drifts", "alpha", "1/s", GAIN / lasts, late, groups + together),
    ):
        for place, some in where:
            joints = np.flatnonzero(acts[:, some].any(axis=1)).tolist()
            of = force if force.ndim == 2 else force[:, :, some].sum(axis=2)
            yield Missing(
                name=name, where=place, phrase=phrase, sizes=(size,), units=(unit,), signs=(0,),
                columns=partial(_at_joints, of, joints), most=(most,),
            )  # fmt: skip


def together(laws: Sequence[Missing]) -> Missing:
    """Returns laws as one candidate with the sizes of all of them."""

    def columns() -> Columns:
        each = [law.columns() for law in laws]
        joints = [j for c in each for j in c.joints or ()]
        some = None if any(c.joints is None for c in each) else tuple(dict.fromkeys(joints))
        return Columns(np.concatenate([c.values for c in each], axis=2), some)

    def every(field: str) -> tuple[Any, ...]:
        return tuple(x for law in laws for x in getattr(law, field))

    return replace(
        laws[0], name=" + ".join(law.name for law in laws), sizes=every("sizes"),
        units=every("units"), signs=every("signs"), most=every("most"), columns=columns,
        shape=every("shape"), of_body=None, reshaped=None,
        ridges=tuple(x for law in laws for x in law.ridges or [0.0] * len(law.sizes)),
    )  # fmt: skip


def in_record(missing: Missing, equations: Equations, record: int) -> Missing:
    """Returns a candidate that acts in one record only."""
    of = equations.record[equations.block] == record

    def columns() -> Columns:
        whole = missing.columns()
        return Columns(whole.values * of[:, None, None], whole.joints)

    name = equations.rows[record].name
    return replace(missing, where=f"{missing.where} in {name}", columns=columns)
