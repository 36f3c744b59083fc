"""Are a setpoint and the measured column of its joint in each other's place?

    r(s) = corr u(t), y(t + s),    |s| <= 0.2 s            y follows u where r is largest at s > 0

A joint follows what its servo wants. Where the position comes first, the setpoint was rather the
measured column, and the position the setpoint. The model is then late twice, which is little where
a motion is slow: so a setpoint that comes late is asked for even where the model explains the log
as it is read.
The columns of a motor are not asked: its torque comes before the motion in a right log, too, and a
model that lacks something may seem to follow a torque better than the position.

A setpoint that was stamped late comes late too, and so does one that copies the position of an arm
that is guided by hand. But then the log with its setpoints shifted back in time is explained as
well as with the columns exchanged, or better: a setpoint is sharper than what follows it. Where
both explain a log, which is the case of slow motions, nothing is refused, and the order is told.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from identification.logs.cures import how_to_rename
from identification.logs.log import Log
from identification.logs.names import listed
from identification.model.predictor import output_columns
from identification.quantities import quantity
from identification.refusals.columns import Doubt
from identification.refusals.judge import Judge
from identification.refusals.readings import Reading
from identification.refusals.same_units import best_lag, wanted_units
from identification.refusals.trust import RobotFile

FOLLOWS = 0.8  # least correlation of a setpoint with what follows it
MOST_LATE, STEPS = 6.0, 9  # times the lead, that setpoints may be stamped late; shifts tried
SHIFTED = 0.5  # of ε of the best shift, that an exchange may leave; of a late stamp it leaves more


@dataclass(frozen=True)
class Pair:
    """A setpoint, and the output of its joint that comes before it."""

    input: int
    output: int
    lead: float  # by which the output comes before what the servo wants [s]


def late_pairs(model: mujoco.MjModel, log: Log) -> list[Pair]:
    """Returns each setpoint of a servo that comes after the output that should follow it."""
    places, wanted = output_columns(model, log.output_names), wanted_units(model, log)
    found = []
    for i, name in enumerate(log.input_names):
        is_joint = model.actuator_trntype[i] == int(mujoco.mjtTrn.mjTRN_JOINT)
        if name not in wanted or not is_joint or not np.ptp(log.inputs[:, i]) > 0:
            continue
        joint = model.actuator_trnid[i, 0]
        position = ("qpos", int(model.jnt_qposadr[joint]))
        rate = ("qvel", int(model.jnt_dofadr[joint]))
        of = rate if wanted[name].endswith("/s") else position
        for k in (k for k, place in enumerate(places) if place == of):
            if lead := _lead(log, log.inputs[:, i], log.outputs[:, k]):
                found.append(Pair(i, k, lead))
    return found


def crossed_readings(doubt: Doubt, pairs: Sequence[Pair]) -> Iterator[Reading]:
    """Yields the log with the columns of each pair in each other's place, and of all pairs."""
    log = doubt.log
    for some in [*([p] for p in pairs), *([pairs] if len(pairs) > 1 else [])]:
        inputs, outputs = [p.input for p in some], [p.output for p in some]
        u, y = log.inputs.copy(), log.outputs.copy()
        u[:, inputs], y[:, outputs] = log.outputs[:, outputs], log.inputs[:, inputs]
        names = {doubt.outputs[p.output]: doubt.inputs[p.input] for p in some}
        new = names | {b: a for a, b in names.items()}
        cure = f"exchange {', '.join(f'{a} and {b}' for a, b in names.items())}{how_to_rename(new)}"
        if any(doubt.column[n] != n for n in doubt.column):
            cure += ", or correct [columns] of the robot's TOML"
        wanted = [log.input_names[k] for k in inputs]
        yield Reading(replace(log, inputs=u, outputs=y), outputs, _words(wanted, some), cure)


def is_no_late_stamp(
    judge: Judge, pairs: Sequence[Pair], reading: Reading, rest: np.ndarray
) -> bool:
    """Returns whether no late stamp explains a log as well as an exchange of columns does.

    Args:
        judge: the model and the log as it is read.
        pairs: those whose input comes late.
        reading: which exchanges some of them.
        rest: its ε, shape (ny,), without unit.
    """
    log, k = judge.log, list(reading.columns)
    some = [p for p in pairs if p.output in k]

    def left(shift: float) -> float:
        u = log.inputs.copy()
        for i in (p.input for p in some):
            u[:, i] = np.interp(log.time + shift, log.time, u[:, i])
        shifted = judge.of(replace(log, inputs=u))
        return np.inf if shifted is None else float(shifted[k].sum())

    lead = max(p.lead for p in some)
    best = min(lead * np.geomspace(1, MOST_LATE, STEPS), key=left)
    near = best * np.geomspace(1 / MOST_LATE, MOST_LATE, STEPS) ** (1 / STEPS)
    return float(rest[k].sum()) < SHIFTED * min(map(left, near))


def late_sentence(file: RobotFile, model: mujoco.MjModel, log: Log) -> str | None:
    """Returns one sentence on positions that come before the setpoints of their servos, or None."""
    late = late_pairs(model, log)
    if not late or "wiring" in file.trust:
        return None
    column = {n: file.columns.get(n, n) for n in (*log.output_names, *log.input_names)}
    names = [(column[log.output_names[p.output]], column[log.input_names[p.input]]) for p in late]
    leads = ", ".join(
        f"{q} moves {quantity(p.lead, unit='s')} before {u}"
        for (q, u), p in zip(names, late, strict=True)
    )
    return (
        f"In log {log.name!r} {leads}, which its servo should follow: the columns may be exchanged,"
        " or the setpoints stamped late; if they are exchanged, give each the other's name under"
        " [columns] of the log's TOML."
    )


def _lead(log: Log, u: np.ndarray, y: np.ndarray) -> float:
    """Returns by how much y comes before u, shape (n,) each, [s]; 0 where it does not."""
    (late, _), (early, lead) = best_lag(log, u, y), best_lag(log, y, u)
    return lead * log.sampling_time if early > max(late, FOLLOWS) else 0.0


def _words(inputs: Sequence[str], pairs: Sequence[Pair]) -> str:
    late = quantity(max(p.lead for p in pairs), unit="s")
    if len(pairs) == 1:
        return f"were it exchanged with {inputs[0]}, which comes {late} after it"
    return f"were they exchanged with {listed(inputs)}, which come up to {late} after them"
