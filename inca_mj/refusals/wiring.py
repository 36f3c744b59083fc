"""Is a log wired as the robot is? Its first motion beside the nominal twin's.

ŷ is a free run under the logged currents until two seconds after the twin begins to move; ε is what
`identification.refusals.readings` takes, here without the scale s, which is judged by itself. A
twin that lacks something is off by a few percent: ε <= 0.11 and 0.77 <= s <= 1.2 over 89 simulated
logs of 25 effects; an anchor that is 0.1 m off makes even ε = 1.5. Where the twin does not move,
nothing is said. A log is believed to be wired in another way only if all its angles, read in that
way, are as near to the twin as those of a right log. Currents are judged by all angles together
(`inca_mj.refusals.currents`).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification import Log, Predictor
from identification.errors import DivergenceError, InputError
from identification.logs.names import listed
from identification.logs.plausible import refuse_frozen
from identification.refusals.readings import Reading
from identification.refusals.trust import trusted
from inca_mj.refusals import bounds
from inca_mj.refusals.agreement import angles_under, some, unreached_share
from inca_mj.refusals.angles import apart, other_angles, with_outputs
from inca_mj.refusals.currents import other_currents, renamed_drives
from inca_mj.refusals.dead_current import dead_current
from inca_mj.refusals.scales import other_unit, scaled_angle, scaled_current
from inca_mj.twin.logs import JUDGED, overruled_by
from inca_mj.twin.twin import Twin

LONGEST = 10.0  # [s] in which motion must begin
MOTION = 0.05  # [rad] of the twin; a hundred times an encoder's noise
BEGINNING = 2.0  # [s] from there; later even a good model has drifted
DEAD = 1e-3  # of the twin's motion
ADVICE = ", with which `inca compare` shows the log beside the twin"


def refuse_miswired(log: Log, plant: Twin, trust: Sequence[str] = ()) -> None:
    """Refuses a log whose angles or currents cannot be those of the drives they are named after.

    It is compared with the nominal twin. `trust` are words of `JUDGED`, judgements that the user
    overrules. Raises InputError if an encoder is dead, frozen, reversed, swapped or in another
    unit, currents are reversed, swapped or were not logged, or a word is unknown.
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
    every = bool(moves.all())
    longer = log.between(float(part.time[0]), float(part.time[-1]) + BEGINNING)  # cannot drift away
    part, predicted = with_outputs(part, moves), predicted[:, moves]
    dead = dead_current(plant, part, predicted) if every else None
    if dead is not None and {*dead[1]} - overruled:
        raise InputError(f"log {log.name!r}: {dead[0]}{overruled_by(*dead[1])}{ADVICE}")
    wiring = None
    if "wiring" not in overruled:
        wiring = _other_wiring(plant, part, predicted, longer if every else None)
    read = part if wiring is None else wiring[0].log
    predicted = predicted if read is part else angles_under(plant, read, read.inputs[None])[0]
    unit = None
    if "units" not in overruled:
        unit = other_unit(read, predicted, "wiring" in overruled or wiring is not None)
        if unit is None and every and wiring is None:
            scaled = scaled_angle(plant, part, predicted)
            scaled = scaled or scaled_current(plant, part, longer, predicted)
            unit = None if scaled is None else (scaled, ("units",))
    wrong: list[tuple[str, tuple[str, ...]]] = []
    wrong += [] if wiring is None else [(f"the twin {wiring[1]}", ("wiring",))]
    wrong += [] if unit is None else [unit]
    if wrong:
        text = "; so read, ".join(sentence for sentence, _ in wrong)
        words = dict.fromkeys(word for _, words in wrong for word in words)
        raise InputError(f"log {log.name!r}: {text}{overruled_by(*words)}{ADVICE}")


def _other_wiring(
    plant: Twin, part: Log, predicted: np.ndarray, longer: Log | None
) -> tuple[Reading, str] | None:
    """Returns another wiring of the angles or of the currents, whichever is nearer to the twin."""
    angles = other_angles(part, predicted)
    if angles is not None and longer is not None and _tears(plant, part, angles[0].log):
        angles = None
    rest = np.inf if angles is None else apart(angles[0].log, predicted)
    if rest <= bounds.ASTRAY:
        return angles
    found = other_currents(plant, part, predicted, longer)
    if found is None and longer is not None and apart(part, predicted) > bounds.ASTRAY:
        found = renamed_drives(plant, part, predicted)
    if found is None:
        return angles
    under = angles_under(plant, part, found[0].log.inputs[None])[0]
    return found if apart(found[0].log, under) < rest else angles


def _tears(plant: Twin, part: Log, other: Log) -> bool:
    """Returns whether another reading's angles belong to no poses, while those as read do."""
    as_read, new = unreached_share(plant, np.stack([some(log.outputs) for log in (part, other)]))
    return bool(new > bounds.AS_NEAR * as_read)


def _moving(part: Log, predicted: np.ndarray) -> np.ndarray:
    """Returns which angles of a log move, where all of the twin's do, shape (8,)."""
    y = part.outputs - part.outputs[0]
    return np.asarray(np.linalg.norm(y, axis=0) > DEAD * np.linalg.norm(predicted, axis=0))


def _standing(part: Log, moves: np.ndarray) -> str:
    """Returns which angles stand still, in words."""
    if not moves.any():
        return "nothing moves in the log though the currents would move the robot"
    names = listed(n for n, moving in zip(part.output_names, moves, strict=True) if not moving)
    return f"{names}: stands still though its motor turns; look for a dead encoder"


def _first_motion(log: Log, plant: Twin) -> tuple[Log, np.ndarray] | None:
    """Returns the log until its first motion ends, n samples, and the twin's angles (n, 8) [rad].

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
