"""The start of simulations of a log, in sentences: what differs from the model or from the log."""

from __future__ import annotations

from collections.abc import Collection

import mujoco

from identification.logs.log import Log
from identification.model.plant import own_start, start_place
from identification.quantities import alike
from identification.robot.file import RobotFile
from identification.robot.start import CLEAR, Begin, measured_begin, moved_begin

LISTED = 3  # joints that a sentence lists


def start_sentence(file: RobotFile, model: mujoco.MjModel, log: Log) -> str | None:
    """Returns one sentence on where a log begins elsewhere than the model, or None."""
    free = {start_place(str(file.records.get(n, {}).get("path", n)), model) for n in file.free}
    moved = [(p, b) for p, b in moved_begin(file, model, log).items() if p not in free]
    if not moved:
        return None
    own, said = own_start(model), []
    for (field, i), begin in moved[:LISTED]:
        of, unit = _what(field, begin, log)
        pair = alike([begin.value, float(getattr(own, field)[i])], unit)
        said.append(f"{of} at {pair[0]} instead of {pair[1]}")
    more = _more(moved)
    return (
        f"Simulations of log {log.name!r} begin where it does, {', '.join(said)}{more}; write"
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
    paths, more = _first(apart), _more(apart)
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
        f"The values make up for {_first(apart)} under [start] of {file.path}, because log"
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
        f"{_first(unused)} under [start] of {file.path} {are} not used,"
        f" because the file gives a horizon: each window of {file.horizon:g} s begins where the log"
        f" is at that time; delete {it}, or delete horizon to simulate a free run from {it}."
    )


def _first(paths: Collection[str]) -> str:
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
