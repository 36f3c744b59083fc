"""The start of a simulation of a log: its measured joints begin where and as fast as the log does.

    y(t) = c_0 + c_1 t + c_2 t²    on the first m samples;  position c_0, rate c_1

The motion is no parabola for long. So m is the largest number of samples whose c_0 and c_1 agree
with those of all fewer ones within their noise (Lepski 1991), and the std is that of the next
fewer, because m samples may err by as much as that hides. A start that differs from the model's by
no more than this is no reason to doubt the model's, which is kept. States that no output measures
begin as the model does, and joints that equalities tie to others where these tell
(`identification.model.equalities`).
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import mujoco
import numpy as np

from identification.errors import InputError, told_of
from identification.logs.log import Log
from identification.logs.noise import noise_floor
from identification.model.equalities import put_tied
from identification.model.plant import own_start, start_place
from identification.model.predictor import output_columns
from identification.model.rollout import State
from identification.quantities import alike
from identification.robot.file.file import RobotFile

LISTED = 3  # joints that a sentence lists
CLEAR = 3.0  # std that a start must differ by; of white noise alone these are 8 std
AGREE = 2.0  # std within which two spans agree
SPANS = (3, 5, 9, 17, 33)  # m that are tried
Place = tuple[str, int]


@dataclass(frozen=True)
class Begin:
    """An entry of the initial state as the log shows it."""

    output: str  # name of the output that shows it
    value: float  # in the unit of the state
    std: float  # of the value, from the noise of the output


def measured_begin(model: mujoco.MjModel, log: Log) -> dict[Place, Begin]:
    """Returns the measured positions and rates of the initial state, by field and index."""
    noise, found = noise_floor(log.outputs), {}
    places = enumerate(output_columns(model, log.output_names))
    for k, (field, i) in sorted(places, key=lambda item: item[1][0]):  # positions, then rates
        name, h = log.output_names[k], log.sampling_time
        (value, rate), std = _first(log.outputs[:, k], h, float(noise[k]))
        found[field, i] = Begin(name, value, std[0])
        if field == "qpos":
            joint = int(np.flatnonzero(model.jnt_qposadr == i)[0])
            found["qvel", int(model.jnt_dofadr[joint])] = Begin(name, rate, std[1])
    return found


def refuse_start(file: RobotFile, model: mujoco.MjModel) -> None:
    """Refuse a path under [start] that names nothing in the state."""
    sizes = {"qpos": model.nq, "qvel": model.nv, "act": model.na}
    with told_of(f"start in {file.path}"):
        for path in file.start:
            if start_place(path, model) is None:
                raise InputError(
                    f"{path!r} is no entry of the state; write one such as"
                    f" {' or '.join(f'{f}[0]' for f, n in sizes.items() if n)}"
                )


def start_of(file: RobotFile, model: mujoco.MjModel, log: Log | None) -> State:
    """Returns the initial state of a simulation of a log, or of the model alone without one.

    What the robot's file gives under [start] stands, and with trust in the start all of the
    model's own stands.
    """
    reset = own_start(model)
    start = {f: np.array(getattr(reset, f)) for f in ("qpos", "qvel", "act")}
    for (field, i), begin in moved_begin(file, model, log).items() if log else ():
        start[field][i] = begin.value
    given = {start_place(path, model): value for path, value in file.start.items()}
    for place, value in given.items():
        if place is not None:
            start[place[0]][place[1]] = value
    moved = np.flatnonzero(start["qpos"] != reset.qpos)
    stands = np.isin(model.jnt_qposadr, [i for f, i in filter(None, given) if f == "qpos"])
    known = np.flatnonzero(stands | np.isin(model.jnt_qposadr, moved))
    put_tied(model, known.tolist(), start["qpos"], start["qvel"])
    return State(**start)


def moved_begin(file: RobotFile, model: mujoco.MjModel, log: Log) -> dict[Place, Begin]:
    """Returns what a log shows to begin elsewhere than the model, where the file gives nothing."""
    if "start" in file.trust:
        return {}
    reset = own_start(model)
    given = {start_place(path, model) for path in file.start}
    return {
        place: begin
        for place, begin in measured_begin(model, log).items()
        if place not in given
        and abs(begin.value - float(getattr(reset, place[0])[place[1]])) > CLEAR * begin.std
    }


def start_sentence(file: RobotFile, model: mujoco.MjModel, log: Log) -> str | None:
    """Returns one sentence on where a log begins elsewhere than the model, or None."""
    free = {start_place(str(file.records.get(n, {}).get("path", n)), model) for n in file.free}
    moved = [(p, b) for p, b in moved_begin(file, model, log).items() if p not in free]
    if not moved:
        return None
    reset, lines = own_start(model), []
    for (field, i), begin in moved[:LISTED]:
        of, unit = _what(field, begin, log)
        pair = alike([begin.value, float(getattr(reset, field)[i])], unit)
        lines.append(f"{of} at {pair[0]} instead of {pair[1]}")
    more = _more(moved)
    return (
        f"Simulations of log {log.name!r} begin where it does, {', '.join(lines)}{more}; write"
        f' trust = ["start"] into {file.path} to begin where {file.model.name} does.'
    )


def given_apart(file: RobotFile, model: mujoco.MjModel, log: Log) -> dict[str, str]:
    """Returns in words, by path, what [start] gives elsewhere than a log begins."""
    begins, found = measured_begin(model, log), {}
    for path, value in file.start.items():
        place = start_place(path, model)
        begin = None if place is None else begins.get(place)
        if place is None or begin is None or abs(value - begin.value) <= CLEAR * begin.std:
            continue
        of, unit = _what(place[0], begin, log)
        (here,) = alike([begin.value], unit)
        found[path] = f"{path} = {value:g} where {of} begins at {here}"
    return found


def apart_sentence(file: RobotFile, model: mujoco.MjModel, log: Log) -> str | None:
    """Returns one sentence on what [start] gives elsewhere than a log begins, or None."""
    apart = given_apart(file, model, log)
    if not apart:
        return None
    paths, more = _listed(apart), _more(apart)
    it = "it" if len(apart) == 1 else "them"
    return (
        f"Simulations of log {log.name!r} begin where [start] of {file.path} says, and it gives"
        f" {', '.join([*apart.values()][:LISTED])}{more}, so that the values of a fit make up for"
        f" this; delete {paths} under [start] to begin where the log does, or move {it} to free to"
        f" fit {it}."
    )


def made_up_sentence(file: RobotFile, model: mujoco.MjModel, log: Log) -> str | None:
    """Returns in short what `apart_sentence` means for values, to stand beside them, or None."""
    apart = given_apart(file, model, log)
    if not apart:
        return None
    return (
        f"The values make up for {_listed(apart)} under [start] of {file.path}, because log"
        f" {log.name!r} begins elsewhere."
    )


def unused_sentence(file: RobotFile, model: mujoco.MjModel, log: Log) -> str | None:
    """Returns one sentence on what of [start] is not used over a horizon; None where all is."""
    begins = measured_begin(model, log)
    unused = [p for p in file.start if start_place(p, model) in begins]
    if not unused:
        return None
    is_one = len(unused) == 1
    it, are = ("it", "is") if is_one else ("them", "are")
    return (
        f"{_listed(unused)} under [start] of {file.path} {are} not used,"
        f" because the file gives a horizon: each window of {file.horizon:g} s begins where the log"
        f" is at that time; delete {it}, or delete horizon to simulate a free run from {it}."
    )


def _listed(paths: Collection[str]) -> str:
    """Returns the first few paths, and how many more there are."""
    return " and ".join([*paths][:LISTED]) + _more(paths)


def _more(items: Collection[object]) -> str:
    """Returns in words how many there are beside those that a sentence lists."""
    return f" and {len(items) - LISTED} more" if len(items) > LISTED else ""


def _what(field: str, begin: Begin, log: Log) -> tuple[str, str]:
    """Returns what an entry of the state is called by the output that shows it, and its unit."""
    unit = log.units.get(begin.output, "")
    if field != "qvel" or unit.endswith("/s"):
        return begin.output, unit
    return f"the rate of {begin.output}", f"{unit}/s" if unit else unit


def _first(y: np.ndarray, h: float, noise: float) -> tuple[tuple[float, float], np.ndarray]:
    """Returns value and rate of a signal at its first sample, and the std of both."""
    # A sample is rounded where it is stored, and a value of that size is no start.
    least = max(noise, 64 * np.finfo(float).eps * float(np.abs(y[: SPANS[0]]).max()))
    found: list[tuple[np.ndarray, np.ndarray]] = []
    for m in SPANS:
        t = h * np.arange(m)
        A = np.stack([np.ones(m), t, t**2], axis=1)
        if m > len(y):
            break
        c = np.linalg.lstsq(A, y[:m], rcond=None)[0][:2]
        if any((np.abs(c - other) > AGREE * std).any() for other, std in found):
            break
        found.append((c, least * np.sqrt(np.diag(np.linalg.pinv(A.T @ A)))[:2]))
    (value, rate), std = found[-1][0], found[max(0, len(found) - 2)][1]
    return (float(value), float(rate)), std
