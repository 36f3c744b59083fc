"""Is a log wired as the robot is? Its first motion beside the nominal twin's.

    ε_k = 1 - ⟨y_k, ŷ_k⟩ / (‖y_k‖ ‖ŷ_k‖),    s_k = ⟨y_k, ŷ_k⟩ / ‖ŷ_k‖²

ŷ is a free run under the logged currents until two seconds after the twin begins to move; ε is what
`identification.logs.readings` takes, here without the scale s, which is judged by itself. A twin
that lacks something is off by a few percent: ε <= 0.11 and 0.77 <= s <= 1.2 over 89 simulated logs
of 25 effects; an anchor that is 0.1 m off makes even ε = 1.5. Where the twin does not move, nothing
is said. A log is believed to be wired in another way only if all its angles, read in that way, are
as near to the twin as those of a right log.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain

import numpy as np

from identification import Log, Predictor
from identification.errors import DivergenceError, InputError
from identification.logs.frozen import refuse_frozen
from identification.logs.names import listed
from identification.logs.readings import Reading, how_to_turn, misread, output_readings, turned
from identification.robot.trust import TRUST, trusted
from inca_mj.twin.twin import Twin

LONGEST = 10.0  # [s] in which motion must begin
MOTION = 0.05  # [rad] of the twin; a hundred times an encoder's noise
BEGINNING = 2.0  # [s] from there; later even a good model has drifted
DEAD = 1e-3  # of the twin's motion
UNIT = (0.2, 10.0)  # of the twin's motion; revolutions are at 0.12 to 0.19, degrees at 44 to 69
RIGHT = 0.2  # ε of a right log; 61 of 65 worlds as built (20000 to 20124) are below, all below 0.4
ADVICE = "; `inca compare` shows the log beside the twin"
JUDGED = {word: TRUST[word] for word in ("sensors", "units", "wiring")}  # a user may overrule


def refuse_miswired(log: Log, plant: Twin, trust: Sequence[str] = ()) -> None:
    """Refuse a log whose angles cannot be those of the drives they are named after.

    Args:
        log: of the robot.
        plant: its nominal twin.
        trust: judgements that the user overrules, words of `JUDGED`.

    Raises:
        InputError: an encoder is dead, frozen, reversed, swapped with another or in another unit,
            or a word is unknown.
    """
    overruled = {*trusted(trust, "--trust", JUDGED)}
    if "sensors" not in overruled:
        for k in range(log.outputs.shape[1]):
            refuse_frozen(log, k, log.inputs[:, [k]], log.outputs[:, :0], _overrule("sensors"))
    found = _first_motion(log, plant) if {*JUDGED} - overruled else None
    if found is None:
        return
    part, predicted = found
    moves = _moving(part, predicted)
    if "sensors" not in overruled and not moves.all():
        raise InputError(f"log {log.name!r}: {_standing(part, moves)}{_overrule('sensors')}")
    if not moves.any():
        return
    part, predicted = _with_outputs(part, moves), predicted[:, moves]
    y = part.outputs - part.outputs[0]
    if "wiring" not in overruled and (other := _other_wiring(part, predicted)) is not None:
        raise InputError(f"log {log.name!r}: the twin {other}{ADVICE}{_overrule('wiring')}")
    scales = np.abs((y * predicted).sum(0) / (predicted**2).sum(0))
    scale, far = float(np.exp(np.mean(np.log(scales)))), np.flatnonzero(scales > UNIT[1])
    if "units" not in overruled and UNIT[0] < scale < UNIT[1] and len(far):
        names = listed(part.output_names[k] for k in far)
        raise InputError(
            f"log {log.name!r}: {names}: moves {scales[far].max():.2g} times as far as the twin's"
            " under these currents, and the other angles do not; all must be in radians (a degree"
            f" is 0.0175){ADVICE}{_overrule('units')}"
        )
    if "units" not in overruled and not UNIT[0] < scale < UNIT[1]:
        raise InputError(
            f"log {log.name!r}: the angles move {scale:.2g} times as far as the twin's under these"
            " currents; they must be in radians (a revolution is 6.28, a degree 0.0175) and"
            f" currents in ampere, each with its sign{ADVICE}{_overrule('units')}"
        )


def _overrule(word: str) -> str:
    """How the user overrules a judgement, for the end of its message."""
    return f"; if you know that {JUDGED[word]}, write --trust {word}"


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


def _other_wiring(part: Log, predicted: np.ndarray) -> str | None:
    """Another wiring of the first motion that explains it as a right log's, in words."""

    def unexplained(other: Log) -> np.ndarray:
        return 1 - np.diag(_alike(other.outputs - other.outputs[0], predicted))

    def as_right(reading: Reading, left: np.ndarray) -> bool:
        return bool((left <= RIGHT).all())

    y = part.outputs - part.outputs[0]
    column = {n: n for n in (*part.output_names, *part.input_names)}
    every = np.ones(y.shape[1], bool)
    readings = chain(output_readings(part, every, column), _several(part, y, predicted))
    found = misread(part, unexplained(part), readings, unexplained, as_right)
    return None if found is None else found[1]


def _several(part: Log, y: np.ndarray, predicted: np.ndarray) -> Iterator[Reading]:
    """What is wrong with several encoders at once: signs, and an exchange of more than two."""
    names, back = part.output_names, np.flatnonzero((y * predicted).sum(axis=0) < 0).tolist()
    if 1 < len(back) < y.shape[1]:
        outputs = turned(part.outputs, back)
        yield Reading(replace(part, outputs=outputs), back, "with the other sign",
                      f"turn the sign of {listed(names[k] for k in back)}"
                      f"{how_to_turn([names[k] for k in back])}")  # fmt: skip
    from scipy.optimize import linear_sum_assignment  # slow to import

    every = np.arange(y.shape[1])
    cosine = _alike(y, predicted)
    for likeness in (cosine, np.abs(cosine)):  # whatever the signs, in the second
        _, at = linear_sum_assignment(1 - likeness)
        moved = np.flatnonzero(at != every).tolist()
        back = np.flatnonzero(cosine[every, at] < 0).tolist() if likeness is not cosine else []
        if len(moved) > 2 or (moved and back):
            outputs = part.outputs.copy()
            outputs[:, at] = turned(part.outputs, back)
            pairs = listed(f"{names[i]} to {names[at[i]]}" for i in moved)
            new = [names[at[i]] for i in back]
            turn = f", and turn the sign of the new {listed(new)}{how_to_turn(new)}" if back else ""
            changed = [k for k in every.tolist() if k in (*at[moved], *at[back])]
            wrong = [k for k in changed if 1 - cosine[k, k] > RIGHT]  # others are right by a mirror
            if not wrong:
                continue
            how = " and turned" if back else ""
            yield Reading(replace(part, outputs=outputs), wrong, f"were they exchanged{how}",
                          f"rename {pairs} under [columns]{turn}")  # fmt: skip


def _alike(y: np.ndarray, predicted: np.ndarray) -> np.ndarray:
    """Cosines between measured and predicted angles, each (N, n): entry i, j of y_i and ŷ_j."""
    sizes = np.linalg.norm(y, axis=0)[:, None] * np.linalg.norm(predicted, axis=0)
    return np.asarray(y.T @ predicted / sizes)


def _first_motion(log: Log, plant: Twin) -> tuple[Log, np.ndarray] | None:
    """The log until its first motion is over, n samples, and the twin's angles, shape (n, 8) [rad].

    None where the twin does not move, or cannot be simulated.
    """
    start = float(log.time[0])
    part = log.between(start, start + LONGEST) if log.duration > LONGEST else log
    try:
        predicted = Predictor(plant, part, (), {}).predict(np.zeros((1, 0)))[0]
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
