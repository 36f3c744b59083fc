"""Numbers of a model that go together: gains of servos, spreads of bodies, terms of motors.

`actuator/NAME.kp` and `actuator/NAME.kv` are the gains of a servo:

    <position>   F = gain u + b_1 l + b_2 dl/dt    gain = kp, b_1 = -kp, b_2 = -kv
    <velocity>   F = gain u + b_2 dl/dt            gain = kv, b_2 = -kv

gain is gainprm[0], b_1 and b_2 are biasprm[1] and biasprm[2], u is the command and l the length of
the actuator. A gain that is moved alone multiplies the command: a servo of gain 17.8 whose command
counts 16.6/17.8 is no servo. So the two numbers are moved together or both are free. An
<intvelocity> is a position servo whose command is integrated, and has its gains. So has a servo
whose command has a unit of its own (`scaled_servo`). Other names:

    <damper>                 F = -kv u dl/dt          actuator/NAME.kv, gainprm[2] = -kv
    filter, filterexact      da/dt = (u - a)/T        actuator/NAME.timeconst, T = dynprm[0]
    <dcmotor>                u = R i + K ω, τ = K i   actuator/NAME.resistance, .motorconst
    a limited force          |F| <= f                 actuator/NAME.forcerange, both of its ends

`body/NAME.spread[k]` is the spread of a body's mass, an inertia that cannot become impossible:

    σ_k = (I_i + I_j - I_k)/2 = ∫ x_k² dm      second moment along principal axis k, [kg m²]
    I_k = σ_i + σ_j

The pseudo-inertia of a body (Wensing, Kim, Slotine 2018) about its centre of mass and in its
principal axes is diag(σ_1, σ_2, σ_3, m). It belongs to a distribution of mass exactly where m and
all σ are positive. So a search over m, the centre and the spreads, each kept positive, meets
possible bodies only, and all of them with these principal axes. Inertias that are searched one by
one may break I_i + I_j >= I_k.

A term of a `dcmotor` that its file omits is read by nothing, because MuJoCo counts the states of a
motor when it compiles the file. A number that would begin a state is refused by its solver later:

    u = R i + K ω + L di/dt                  te = L/R: without `inductance` the current has no state
    τ = K i - σ₀ z - σ₁ ż                    without `lugre` (σ₀ = 0) z has no state
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from identification.errors import InputError, unknown_name
from identification.model.paths import Slot, read, resolve
from identification.model.scaled_servo import is_scaled_servo, scaling

_SPREAD = re.compile(r"body/(?P<name>[^.]+)\.spread\[(?P<axis>[0-2])\]")
Place = tuple[int, int]
_DCMOTOR = int(mujoco.mjtDyn.mjDYN_DCMOTOR) if hasattr(mujoco.mjtDyn, "mjDYN_DCMOTOR") else -1
Entry = tuple[str, int]  # array of the model and its column
_GAINPRM, _BIASPRM, _DYNPRM = "actuator_gainprm", "actuator_biasprm", "actuator_dynprm"
_BASE: Mapping[Entry, str] = {(_GAINPRM, 0): "resistance R", (_GAINPRM, 1): "motor constant K"}
NAMES = ("kp", "kv", "timeconst", "resistance", "motorconst", "forcerange")
_NAME = re.compile(rf"(?P<actuator>actuator/[^.]+)\.(?P<name>{'|'.join(NAMES)})")
_FILTERS = {int(getattr(mujoco.mjtDyn, f"mjDYN_{d}")) for d in ("FILTER", "FILTEREXACT")}
_FIXED, _AFFINE = int(mujoco.mjtGain.mjGAIN_FIXED), int(mujoco.mjtBias.mjBIAS_AFFINE)
_AFFINE_GAIN, _NO_BIAS = int(mujoco.mjtGain.mjGAIN_AFFINE), int(mujoco.mjtBias.mjBIAS_NONE)
_WANTS = {"position": 1, "velocity": 2}  # what a servo follows, and where its bias stands


def parts(model: mujoco.MjModel, path: str) -> tuple[tuple[str, float], ...]:
    """Returns the paths to single numbers of a model that a path writes, each with its factor."""
    match = _NAME.fullmatch(path)
    if match is None:
        return ((path, 1.0),)
    at, gain = match["actuator"], match["name"]
    rows = resolve(model, f"{at}.gainprm[0]").rows
    if gain not in ("kp", "kv"):
        return _named(model, at, gain, rows)
    if gain == "kv" and all(is_damper(model, row) for row in rows):
        return ((f"{at}.gainprm[2]", -1.0),)
    kinds = {servo_kind(model, row) for row in rows}
    if kinds == {"position"}:
        if gain == "kv":
            return ((f"{at}.biasprm[2]", -1.0),)
        return ((f"{at}.gainprm[0]", 1.0), (f"{at}.biasprm[1]", -1.0))
    if kinds == {"velocity"} and gain == "kv":
        return ((f"{at}.gainprm[0]", 1.0), (f"{at}.biasprm[2]", -1.0))
    if all(is_scaled_servo(model, row) for row in rows):
        if gain == "kv":
            return ((f"{at}.biasprm[2]", -1.0),)
        if len(meant := {scaling(model, row) for row in rows}) == 1:
            scale, offset = meant.pop()
            moved = ((f"{at}.biasprm[1]", -1.0), (f"{at}.gainprm[0]", scale))
            return (*moved, (f"{at}.biasprm[0]", offset)) if offset else moved
    wanted = "<position> servo" if gain == "kp" else "<position> or <velocity> servo, or <damper>"
    many = "are not all of one kind of" if len(rows) > 1 else "is no"
    raise InputError(
        f"{path!r}: {at.removeprefix('actuator/')!r} {many} {wanted}, whose gain this would be;"
        f" free the numbers that the actuator has, such as {at}.gainprm[0] or {at}.gear[0]"
    )


def _named(
    model: mujoco.MjModel, at: str, name: str, rows: Sequence[int]
) -> tuple[tuple[str, float], ...]:
    """Returns the numbers of actuators that are called by a name of MJCF."""
    if name == "timeconst":
        if all(is_filtered(model, row) for row in rows):
            return ((f"{at}.dynprm[0]", 1.0),)
        lacks = "has no filter between command and force; give it dyntype, or free another number"
    elif name == "forcerange":
        ends = model.actuator_forcerange[list(rows)]
        if all(model.actuator_forcelimited[list(rows)]) and (ends[:, 0] == -ends[:, 1]).all():
            return ((f"{at}.forcerange[1]", 1.0), (f"{at}.forcerange[0]", -1.0))
        lacks = "has no forcerange with ends -f and f; give it one, or free forcerange[0] and [1]"
    else:
        if all(int(model.actuator_dyntype[row]) == _DCMOTOR for row in rows):
            return ((f"{at}.gainprm[{int(name == 'motorconst')}]", 1.0),)
        lacks = "is no <dcmotor>; free the numbers that it has, such as gear[0] or gainprm[0]"
    raise InputError(f"'{at}.{name}': {at.removeprefix('actuator/')!r} {lacks}")


def is_damper(model: mujoco.MjModel, row: int) -> bool:
    """Returns whether an actuator is a <damper>, whose command is its damping."""
    gain = model.actuator_gainprm[row]
    return bool(
        int(model.actuator_gaintype[row]) == _AFFINE_GAIN
        and int(model.actuator_biastype[row]) == _NO_BIAS
        and not gain[:2].any()
        and gain[2] < 0
    )


def value_of(model: mujoco.MjModel, path: str) -> float:
    """Returns the number that a model has at a path, also where it is the gain of a servo."""
    first, factor = parts(model, path)[0]
    return factor * read(model, resolve(model, first)) or 0.0  # and never -0


def servo_kind(model: mujoco.MjModel, row: int) -> str | None:
    """Returns what an actuator follows, "position" or "velocity"; None where it is no servo."""
    if (int(model.actuator_gaintype[row]), int(model.actuator_biastype[row])) != (_FIXED, _AFFINE):
        return None
    gain, bias = float(model.actuator_gainprm[row, 0]), model.actuator_biasprm[row]
    if bias[1] == -gain and (gain or not bias[2]):
        return "position"
    return "velocity" if gain and not bias[1] and bias[2] == -gain else None


def is_filtered(model: mujoco.MjModel, row: int) -> bool:
    """Returns whether an actuator acts by what a filter of first order makes of its command."""
    return int(model.actuator_dyntype[row]) in _FILTERS


def follows(model: mujoco.MjModel, row: int) -> str | None:
    """Returns what an actuator follows, as `servo_kind` does, also where its command is scaled."""
    return "position" if is_scaled_servo(model, row) else servo_kind(model, row)


def gain_path(model: mujoco.MjModel, row: int) -> str:
    """Returns the path of the number by which all grows that an actuator gives; "" without a name.

    Of a position servo it is kp: the damping kv, which is a number by itself, stays as it is.
    """
    name = model.actuator(row).name
    gain = {"position": "kp", "velocity": "kv", None: "gear[0]"}[servo_kind(model, row)]
    return f"actuator/{name}.{gain}" if name else ""


def is_set_point(model: mujoco.MjModel, control: int) -> bool:
    """Returns whether an input is what servos are told to reach, and no force."""
    rows = [i for i in range(len(model.actuator_trntype)) if model.actuator_ctrladr[i] == control]
    return bool(rows) and all(servo_kind(model, i) is not None for i in rows)


def refuse_half(model: mujoco.MjModel, paths: Sequence[tuple[str, str]]) -> None:
    """Refuse parameters that move one of two numbers of a servo which are one gain."""
    moved: dict[tuple[str, int], str] = {}
    for name, path in paths:
        if path.startswith("actuator/") and path.endswith(("prm[0]", "prm[1]", "prm[2]")):
            slot = resolve(model, path)
            moved |= {(_entry(slot), row): name for row in slot.rows}
    for (entry, row), name in moved.items():
        kind = servo_kind(model, row)
        if kind is None:
            continue
        pair = ("gainprm[0]", f"biasprm[{_WANTS[kind]}]")
        if entry not in pair or float(model.actuator_gainprm[row, 0]) == 0:
            continue
        other = pair[1 - pair.index(entry)]
        if (other, row) in moved:
            continue
        servo = model.actuator(row).name
        gain = "kp" if kind == "position" else "kv"
        raise InputError(
            f"{name} moves {entry} of the <{kind}> servo {servo!r} alone, whose {other} is tied to"
            f" it ({pair[1]} = -{pair[0]}), so that it would scale the servo's"
            f" {'command' if entry == pair[0] else 'feedback'} and not its gain; free"
            f" actuator/{servo}.{gain}, which moves both, or free actuator/{servo}.{other} too"
        )


def spread_place(path: str, model: mujoco.MjModel) -> Place | None:
    """Returns body and axis of a path such as `body/link.spread[0]`; None for any other path."""
    match = _SPREAD.fullmatch(path)
    if match is None:
        if path.startswith("body/") and ".spread" in path:
            raise InputError(f"{path!r}: a spread has an axis, such as body/NAME.spread[0], 1 or 2")
        return None
    names = [model.body(i).name for i in range(model.nbody)]
    if match["name"] not in names:
        raise unknown_name("body", match["name"], filter(None, names))
    return names.index(match["name"]), int(match["axis"])


def spreads(model: mujoco.MjModel, body: int) -> np.ndarray:
    """Returns σ of a body, shape (3,) [kg m²]."""
    inertia = model.body_inertia[body]
    return np.asarray(inertia.sum() / 2 - inertia)


def with_spreads(
    model: mujoco.MjModel, values: Mapping[Place, np.ndarray], count: int
) -> list[tuple[Slot, np.ndarray]]:
    """Returns the entries of a model that spreads change, with principal inertias (count,) [kg m²].

    The spreads are given by body and axis, shape (count,) [kg m²]; others are those of the model.
    """
    found: list[tuple[Slot, np.ndarray]] = []
    for body in dict.fromkeys(body for body, _ in values):
        sigma = np.tile(spreads(model, body), (count, 1))
        for (other, axis), column in values.items():
            if other == body:
                sigma[:, axis] = column
        inertia = sigma.sum(axis=1, keepdims=True) - sigma
        found += [(Slot("body_inertia", (body,), k), inertia[:, k]) for k in range(3)]
    return found


def refuse_both(paths: Sequence[str], model: mujoco.MjModel) -> None:
    """Refuse parameters that move a body's spreads and its inertias at once."""
    for path in paths:
        place = spread_place(path, model)
        if place is None:
            continue
        name = model.body(place[0]).name
        other = next((p for p in paths if p.startswith(f"body/{name}.inertia")), None)
        if other is not None:
            raise InputError(f"{path} and {other} move the same inertia; free the spreads alone")


@dataclass(frozen=True)
class Term:
    """A term of the motor that a file may leave out."""

    words: str  # what it is
    attribute: str  # of `dcmotor`, which gives it
    begins: Entry  # the number that is zero without it, and that gives the motor a state
    symbols: Mapping[Entry, str]  # its numbers


def refuse_unread(model: mujoco.MjModel, name: str, slot: Slot, path: str) -> None:
    """Refuse a parameter of a `dcmotor` that belongs to a term which the model does not have."""
    entry = (slot.field, slot.column if slot.column is not None else -1)
    term = next((t for t in _TERMS if entry in t.symbols), None)
    if term is None:
        return
    field, column = term.begins
    for row in slot.rows:
        if int(model.actuator_dyntype[row]) != _DCMOTOR or getattr(model, field)[row, column] != 0:
            continue
        motor = mujoco.mj_id2name(model, int(mujoco.mjtObj.mjOBJ_ACTUATOR), row) or f"#{row}"
        raise InputError(
            f"{name} ({path}) is {term.symbols[entry]} of the {term.words} of the dcmotor {motor},"
            f" which this model does not have, so that it has no effect: write {term.attribute}"
            f" into the model, or free another of its parameters: {_readable(model, row, motor)}"
        )


_TERMS = (
    Term(
        "LuGre friction", 'lugre="σ₀ σ₁ τ_c τ_s ω_s"', (_DYNPRM, 5),
        {
            (_DYNPRM, 5): "σ₀", (_DYNPRM, 6): "σ₁",
            (_BIASPRM, 3): "τ_c", (_BIASPRM, 4): "τ_s", (_BIASPRM, 5): "ω_s",
        },
    ),
    Term("inductance", 'inductance="L"', (_DYNPRM, 0), {(_DYNPRM, 0): "time constant L/R"}),
)  # fmt: skip


def _readable(model: mujoco.MjModel, row: int, motor: str) -> str:
    """Returns the numbers of a motor that can be freed, in words."""
    there = dict(_BASE)
    for term in _TERMS:
        field, column = term.begins
        if getattr(model, field)[row, column] != 0:
            there |= term.symbols
    return ", ".join(
        f"actuator/{motor}.{field.removeprefix('actuator_')}[{column}] ({symbol})"
        for (field, column), symbol in there.items()
    )


def _entry(slot: Slot) -> str:
    """Returns the name of a number of an actuator in a path, such as "gainprm[0]"."""
    return f"{slot.field.removeprefix('actuator_')}[{slot.column}]"
