"""Angles of several turns that may be degrees, or counts of an encoder, taken for radians.

    q = 2π (x - x_0)/N              N counts a turn; x_0 is 0, or N/2 where an encoder counts from 0

No word of a unit stands for counts, because N differs from encoder to encoder: a factor says it,
and x_0 stands under [zeros]. That angles are many is no proof, because a wheel turns on and on. So
the counts are readings among others (`identification.refusals.wiring`), and where nothing decides
they are told as what may be.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, product

import mujoco
import numpy as np

from identification.logs.cures import lines_of, unit_lines
from identification.logs.log import Log
from identification.logs.names import listed
from identification.logs.units import UNITS
from identification.model.predictor import output_columns, output_dofs
from identification.refusals.columns import Doubt, factor_readings, unit_readings
from identification.refusals.readings import Reading
from identification.storage.files import toml_key

FAR_ANGLE = 4 * np.pi  # [rad]; an arm's joint hardly turns twice to one side
FEW = 20  # numbers that are whole by chance, such as those of a joint that hardly moves
TURN = 360.0  # [deg]; whole numbers beyond it are rather counts than degrees
# Counts a turn, the usual ones first: servos (4096, and 1024 in 300 degrees), encoders, and tenths
# and hundredths of a degree.
COUNTS = (4096, 1024, 1228.8, 2048, 8192, 16384, 65536, 3600, 36000)
OR_COUNTS = "or, if they are counts of an encoder, 2π over its counts a turn under [factors]"
_SHORTER = ("", "mm", "cm")  # units of the slides beside counts
_HINGE = int(mujoco.mjtJoint.mjJNT_HINGE)


def far_angles(model: mujoco.MjModel, log: Log) -> list[str]:
    """Returns the outputs that are positions of hinges and go farther than two turns."""
    is_far = np.abs(log.outputs).max(axis=0) > FAR_ANGLE
    return [n for k, n in enumerate(log.output_names) if is_far[k] and _is_angle(model, log, k)]


def far_readings(
    doubt: Doubt, model: mujoco.MjModel, wanted: Mapping[str, str]
) -> tuple[Iterator[Reading], Iterator[Reading]]:
    """Returns the likelier readings of angles that go far, and the others: counts and units.

    How large a unit is, is told
    roughly by what a model explains, so that milliradians may be counts.
    """
    counts = count_readings(doubt, model, wanted)
    units = (
        replace(r, cure=f"{r.cure} ({OR_COUNTS})") if "mrad" in r.words else r
        for r in unit_readings(doubt, wanted, alone=False)
    )
    others = chain(factor_readings(doubt), units)
    return (counts, others) if _are_counts(model, doubt.log) else (others, counts)


def count_readings(
    doubt: Doubt, model: mujoco.MjModel, wanted: Mapping[str, str]
) -> Iterator[Reading]:
    """Yields all angles as counts of an encoder where some go far, slides in a shorter unit too.

    Wanted positions have SI units by name; they are counts too where they go far. A log whose
    columns have factors already is left to `factor_readings`.
    """
    log, far = doubt.log, far_angles(model, doubt.log)
    angles = [k for k in range(len(log.output_names)) if _is_angle(model, log, k)]
    if not far or log.factors or log.zeros or not doubt.bad[angles].all():
        return
    outputs = [log.output_names[k] for k in angles]
    inputs = [n for n in log.input_names if wanted.get(n) == "rad"]
    if not any(np.abs(log.columns[n]).max() > FAR_ANGLE for n in inputs):
        inputs = []
    slides = [n for n in log.output_names if log.units.get(n) == "m"]
    slides += [n for n in log.input_names if wanted.get(n) == "m"]
    names = [*outputs, *inputs]
    for word, count, middle in product(_SHORTER if slides else [""], COUNTS, (False, True)):
        zero, factor = count / 2 * middle, 2 * np.pi / count
        size = dict.fromkeys(names, factor) | {n: UNITS[word][1] for n in slides if word}
        begin = dict.fromkeys(names, zero)
        columns = [doubt.column[n] for n in names]
        of = " that count from 0 where the model is at minus half a turn" if middle else ""
        shorter = {doubt.column[n]: word for n in slides if word}
        yield Reading(
            replace(log, outputs=_read(log.outputs, log.output_names, begin, size),
                    inputs=_read(log.inputs, log.input_names, begin, size)),
            doubt.wrong if inputs or shorter else angles,
            f"were its angles counts of an encoder, {count:g} a turn{of}"
            + (f", and the rest in {word}" if shorter else ""),
            " and ".join([
                _table(columns, factor, "factors"), *([_table(columns, zero, "zeros")] * middle),
                *([unit_lines(shorter)] if shorter else []),
            ]),
            ("units",),
        )  # fmt: skip


def far_sentence(model: mujoco.MjModel, log: Log, column: Mapping[str, str]) -> str:
    """Returns what angles of several turns may be, and the cure; "" where none go so far."""
    if not (far := far_angles(model, log)):
        return ""
    farthest = _farthest(log, far)
    names = [column.get(n, n) for n in far]
    go, it = ("goes", "it is") if len(names) == 1 else ("go", "they are")
    cure = (
        f"counts of an encoder, {_table(names, 2 * np.pi / COUNTS[0], 'factors')} (2π over the"
        f" counts a turn, here {COUNTS[0]})"
        if _are_counts(model, log)
        else f"degrees, {unit_lines(dict.fromkeys(names, 'deg'))}"
    )
    return (
        f"{listed(names)} of log {log.name!r} {go} as far as {farthest:.3g} rad,"
        f" {farthest / (2 * np.pi):.3g} turns: if {it} in {cure}, and the setpoints alike"
    )


def are_whole(model: mujoco.MjModel, log: Log) -> bool:
    """Returns whether some angles go far, all of them in whole numbers, as only encoders count."""
    far = [log.columns[n] for n in far_angles(model, log)]
    return bool(far) and all(len(np.unique(y)) > FEW and (y == np.round(y)).all() for y in far)


def _are_counts(model: mujoco.MjModel, log: Log) -> bool:
    """Returns whether angles that go far are rather counts than degrees."""
    farthest = _farthest(log, far_angles(model, log))
    return farthest > 2 * TURN or (are_whole(model, log) and farthest > TURN)


def _farthest(log: Log, names: Sequence[str]) -> float:
    return max(float(np.abs(log.columns[n]).max()) for n in names)


def _is_angle(model: mujoco.MjModel, log: Log, output: int) -> bool:
    field, _ = output_columns(model, log.output_names)[output]
    joint = model.dof_jntid[output_dofs(model, log.output_names)[output]]
    return field == "qpos" and model.jnt_type[joint] == _HINGE


def _read(
    signals: np.ndarray, names: Sequence[str], zero: Mapping[str, float],
    size: Mapping[str, float],
) -> np.ndarray:  # fmt: skip
    """Returns signals (n, m) from their zeros and in units of a size, by name."""
    begin = np.array([zero.get(n, 0.0) for n in names])
    return np.asarray((signals - begin) * [size.get(n, 1.0) for n in names])


def _table(columns: list[str], number: float, table: str) -> str:
    lines = lines_of([f"{toml_key(name)} = {number:.9g}" for name in columns])
    return f"write {lines} under [{table}] of the log's TOML"
