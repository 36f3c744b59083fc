"""The gains of MuJoCo's servos as one parameter each: `actuator/NAME.kp` and `actuator/NAME.kv`.

    <position>   F = gain u + b_1 l + b_2 dl/dt    gain = kp, b_1 = -kp, b_2 = -kv
    <velocity>   F = gain u + b_2 dl/dt            gain = kv, b_2 = -kv

gain is gainprm[0], b_1 and b_2 are biasprm[1] and biasprm[2], u is the command and l the length of
the actuator. A gain that is moved alone multiplies the command: a servo of gain 17.8 whose command
counts 16.6/17.8 is no servo. So the two numbers are moved together or both are free.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import mujoco

from identification.errors import InputError
from identification.model.paths import Slot, read, resolve

_GAIN = re.compile(r"(?P<actuator>actuator/[^.]+)\.(?P<gain>kp|kv)")
_FIXED, _AFFINE = int(mujoco.mjtGain.mjGAIN_FIXED), int(mujoco.mjtBias.mjBIAS_AFFINE)
_WANTS = {"position": 1, "velocity": 2}  # what a servo follows, and where its bias stands


def parts(model: mujoco.MjModel, path: str) -> tuple[tuple[str, float], ...]:
    """Returns the paths to single numbers of a model that a path writes, each with its factor."""
    match = _GAIN.fullmatch(path)
    if match is None:
        return ((path, 1.0),)
    at, gain = match["actuator"], match["gain"]
    rows = resolve(model, f"{at}.gainprm[0]").rows
    kinds = {servo_kind(model, row) for row in rows}
    if kinds == {"position"}:
        if gain == "kv":
            return ((f"{at}.biasprm[2]", -1.0),)
        return ((f"{at}.gainprm[0]", 1.0), (f"{at}.biasprm[1]", -1.0))
    if kinds == {"velocity"} and gain == "kv":
        return ((f"{at}.gainprm[0]", 1.0), (f"{at}.biasprm[2]", -1.0))
    wanted = "<position> servo" if gain == "kp" else "<position> or <velocity> servo"
    many = "are not all of one kind of" if len(rows) > 1 else "is no"
    raise InputError(
        f"{path!r}: {at.removeprefix('actuator/')!r} {many} {wanted}, whose gain this would be;"
        f" free the numbers that the actuator has, such as {at}.gainprm[0] or {at}.gear[0]"
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


def _entry(slot: Slot) -> str:
    """Returns the name of a number of an actuator in a path, such as "gainprm[0]"."""
    return f"{slot.field.removeprefix('actuator_')}[{slot.column}]"
