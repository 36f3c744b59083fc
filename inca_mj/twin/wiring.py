"""Is a log wired as the robot is? Its first motion beside the nominal twin's.

    ε_k = 1 - ⟨y_k, ŷ_k⟩ / (‖y_k‖ ‖ŷ_k‖),    s_k = ⟨y_k, ŷ_k⟩ / ‖ŷ_k‖²

ŷ is a free run under the logged currents until two seconds after the twin begins to move; ε is what
`identification.logs.readings` takes, here without the scale s, which is judged by itself. A twin
that lacks something is off by a few percent: ε <= 0.11 and 0.77 <= s <= 1.2 over 89 simulated logs
of 25 effects; an anchor that is 0.1 m off makes even ε = 1.5. Where the twin does not move, nothing
is said. A log is believed to be wired in another way only if all its angles, read in that way, are
as near to the twin as those of a right log. Currents are judged by all angles together
(`inca_mj.twin.other_currents`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from identification import Log, Predictor
from identification.errors import DivergenceError, InputError
from identification.logs.cures import unit_lines
from identification.logs.frozen import refuse_frozen
from identification.logs.names import listed
from identification.logs.readings import Reading
from identification.logs.units import UNITS
from identification.robot.same_units import NEAR
from identification.robot.trust import trusted
from inca_mj.twin.judged import JUDGED, overruled_by
from inca_mj.twin.other_currents import Predict, apart, other_currents
from inca_mj.twin.other_wiring import other_wiring
from inca_mj.twin.twin import Twin

LONGEST = 10.0  # [s] in which motion must begin
MOTION = 0.05  # [rad] of the twin; a hundred times an encoder's noise
BEGINNING = 2.0  # [s] from there; later even a good model has drifted
DEAD = 1e-3  # of the twin's motion
UNIT = (0.2, 10.0)  # of the twin's motion; revolutions are at 0.12 to 0.19, degrees at 44 to 69
ADVICE = ", with which `inca compare` shows the log beside the twin"


def refuse_miswired(log: Log, plant: Twin, trust: Sequence[str] = ()) -> None:
    """Refuse a log whose angles or currents cannot be those of the drives they are named after.

    Args:
        log: of the robot.
        plant: its nominal twin.
        trust: judgements that the user overrules, words of `JUDGED`.

    Raises:
        InputError: an encoder is dead, frozen, reversed, swapped with another or in another unit,
            a current is reversed or swapped, or a word is unknown.
    """
    overruled = {*trusted(trust, "given as trust", JUDGED)}
    if "sensors" not in overruled:
        for k in range(log.outputs.shape[1]):
            refuse_frozen(log, k, log.inputs[:, [k]], log.outputs[:, :0], overruled_by("sensors"))
    found = _first_motion(log, plant) if {*JUDGED} - overruled else None
    if found is None:
        return
    part, predicted = found
    moves = _moving(part, predicted)
    if "sensors" not in overruled and not moves.all():
        raise InputError(f"log {log.name!r}: {_standing(part, moves)}{overruled_by('sensors')}")
    if not moves.any():
        return
    predict = partial(_predicted, plant, part, moves)
    part, predicted = _with_outputs(part, moves), predicted[:, moves]
    wiring = None if "wiring" in overruled else _other_wiring(part, predicted, predict)
    read = part if wiring is None else wiring[0].log
    predicted = predicted if read is part else predict(read.inputs)
    unit = None if "units" in overruled else _other_unit(read, predicted)
    wrong = {"wiring": f"the twin {wiring[1]}" if wiring is not None else None, "units": unit}
    said = {word: sentence for word, sentence in wrong.items() if sentence is not None}
    if said:
        both = "; so read, " if len(said) > 1 else ""
        raise InputError(
            f"log {log.name!r}: {both.join(said.values())}{overruled_by(*said)}{ADVICE}"
        )


def _other_unit(part: Log, predicted: np.ndarray) -> str | None:
    """What tells that angles are in another unit than radians, and the cure; None if nothing does.

    Args:
        part: the first motion, n samples of angles that all move.
        predicted: the twin's angles, shape (n, angles) [rad].
    """
    y = part.outputs - part.outputs[0]
    scales = np.abs((y * predicted).sum(0) / (predicted**2).sum(0))
    scale, far = float(np.exp(np.mean(np.log(scales)))), np.flatnonzero(scales > UNIT[1])
    if UNIT[0] < scale < UNIT[1] and len(far):
        names, most = [part.output_names[k] for k in far], float(scales[far].max())
        return (
            f"{listed(names)}: moves {most:.2g} times as far as the twin's"
            " under these currents, and the other angles do not; all must be in radians (a degree"
            f" is 0.0175){_how_to_convert(names, most)}"
        )
    if not UNIT[0] < scale < UNIT[1]:
        return (
            f"the angles move {scale:.2g} times as far as the twin's under these"
            " currents; they must be in radians (a revolution is 6.28, a degree 0.0175) and"
            f" currents in ampere, each with its sign{_how_to_convert(['angle'], scale)}"
        )
    return None


def _how_to_convert(columns: Sequence[str], scale: float) -> str:
    """What the TOML must say of angles that move so many times as far as the twin's."""
    fitting = (word for word, (si, factor) in UNITS.items()
               if si == "rad" and 1 / NEAR < scale * factor < NEAR)  # fmt: skip
    word = next(fitting, None)
    if word is None:
        return ""
    return f": {unit_lines(dict.fromkeys(columns, word))}, or correct the unit that it has"


def _other_wiring(part: Log, predicted: np.ndarray, predict: Predict) -> tuple[Reading, str] | None:
    """Another wiring of the angles or of the currents: the one that comes nearer to the twin."""
    found = other_wiring(part, predicted), other_currents(part, predicted, predict)
    return min(
        (each for each in found if each is not None),
        key=lambda each: apart(each[0].log, predict(each[0].log.inputs)),
        default=None,
    )


def _predicted(plant: Twin, part: Log, kept: np.ndarray, currents: np.ndarray) -> np.ndarray:
    """Some of the twin's angles under other currents, shape (n, angles) [rad].

    Raises:
        DivergenceError: the twin cannot be simulated under these.
    """
    other = replace(part, inputs=currents)
    return np.asarray(Predictor(plant, other, (), {}).predict(np.zeros((1, 0)))[0][:, kept])


def _moving(part: Log, predicted: np.ndarray) -> np.ndarray:
    """Which angles of a log move, beside the twin's, which all do, shape (8,)."""
    y = part.outputs - part.outputs[0]
    return np.asarray(np.linalg.norm(y, axis=0) > DEAD * np.linalg.norm(predicted, axis=0))


def _standing(part: Log, moves: np.ndarray) -> str:
    """Which angles stand still, in words."""
    if not moves.any():
        return "nothing moves in the log though the currents would move the robot"
    names = listed(n for n, moving in zip(part.output_names, moves, strict=True) if not moving)
    return f"{names}: stands still though its motor turns; look for a dead encoder"


def _with_outputs(part: Log, kept: np.ndarray) -> Log:
    """A log with some of its outputs, by a mask: what stands still has no sign and no scale."""
    names = tuple(n for n, keep in zip(part.output_names, kept, strict=True) if keep)
    return replace(part, outputs=part.outputs[:, kept], output_names=names, units={}, extras={})


def _first_motion(log: Log, plant: Twin) -> tuple[Log, np.ndarray] | None:
    """The log until its first motion is over, n samples, and the twin's angles, shape (n, 8) [rad].

    None where the twin does not move, or cannot be simulated.
    """
    start = float(log.time[0])
    part = log.between(start, start + LONGEST) if log.duration > LONGEST else log
    every = np.ones(part.outputs.shape[1], bool)
    try:
        predicted = _predicted(plant, part, every, part.inputs)
    except DivergenceError:  # the search says what to do
        return None
    late = np.flatnonzero(np.abs(predicted).max(axis=1) > MOTION)
    if not len(late):
        return None
    rows = slice(int(late[0]), int(late[0]) + round(BEGINNING / log.sampling_time))
    if not (np.sqrt(np.mean(predicted[rows] ** 2, axis=0)) > MOTION).all():
        return None
    n = len(predicted[: rows.stop])
    return part.between(start, float(part.time[n - 1]) + log.sampling_time / 2), predicted[:n]
