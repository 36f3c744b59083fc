"""Other signs and places of a log's columns: which the twin explains, in words, and their cure.

    y' = y Pᵀ,    u' = u Qᵀ;    P_km = ±1 where column m is the angle of drive k with this sign

P and Q are signed permutations, the identity where a log is right. The nearness of angles is

    ε_k = 1 - ⟨y_k, ŷ_k⟩ / (‖y_k‖ ‖ŷ_k‖)                                     of each angle
    γ = 1 - Σ_k ⟨y_k, ŷ_k⟩ / √(Σ_k ‖y_k‖² Σ_k ‖ŷ_k‖²)                         over all together
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain

import numpy as np

from identification import Log
from identification.logs.cures import how_to_rename, how_to_turn
from identification.logs.names import listed
from identification.refusals.columns import Doubt, output_readings, turned
from identification.refusals.readings import Reading, misread
from inca_mj.refusals import bounds
from inca_mj.refusals.agreement import assigned


def other_angles(part: Log, predicted: np.ndarray) -> tuple[Reading, str] | None:
    """Returns another wiring of the angles that explains the first motion as a right log's.

    All of its angles move; those of the twin are predicted, shape (n, angles) [rad].
    """
    doubt = Doubt.of(part, {n: n for n in (*part.output_names, *part.input_names)})
    # A cable pulls and does not push: other signs of all currents are no mirror of all angles.
    readings = chain(output_readings(doubt, False), _several(part, predicted))
    return misread(
        part, off(part, predicted), readings, lambda reading: off(reading.log, predicted),
        lambda reading, rest: bool((rest <= bounds.RIGHT).all()),
    )  # fmt: skip


def _several(part: Log, predicted: np.ndarray) -> Iterator[Reading]:
    """Yields readings with several wrong encoders: signs, and an exchange of more than two."""
    names, cosine = part.output_names, alike(part, predicted)
    every, right = np.arange(len(cosine)), np.diag(cosine)
    back = np.flatnonzero(right < 0).tolist()
    if 1 < len(back) < len(every):
        outputs = turned(part.outputs, back)
        yield Reading(replace(part, outputs=outputs), back, "with the other sign",
                      how_to_turn([names[k] for k in back], part.factors))  # fmt: skip
    for likeness in (cosine, np.abs(cosine)):  # whatever the signs, in the second
        at = assigned(likeness)
        moved = np.flatnonzero(at != every).tolist()
        back = np.flatnonzero(cosine[every, at] < 0).tolist() if likeness is not cosine else []
        if len(moved) < 3 and not (moved and back):
            continue
        outputs = part.outputs.copy()
        outputs[:, at] = turned(part.outputs, back)
        changed = np.intersect1d(every, [*at[moved], *at[back]])
        wrong = [k for k in changed.tolist() if 1 - right[k] > bounds.RIGHT]
        if not wrong:  # all are right by a mirror
            continue
        new_names = {names[i]: names[at[i]] for i in moved}
        text, cure = "were they exchanged", f"rename {_pairs(new_names)}{how_to_rename(new_names)}"
        if back:
            text += " and turned"
            cure += f", and {how_to_turn([names[at[i]] for i in back], renamed=True)}"
        yield Reading(replace(part, outputs=outputs), wrong, text, cure)


def rewired(part: Log, P: np.ndarray, Q: np.ndarray) -> Reading:
    """Returns a log read with other places and signs P (k, k), Q (8, 8), not both the identity."""
    renamed: dict[str, str] = {}
    back: list[str] = []
    for names, matrix in ((part.output_names, P), (part.input_names, Q)):
        for k, m in zip(*np.nonzero(matrix), strict=True):
            if k != m:
                renamed[names[m]] = names[k]
            if matrix[k, m] < 0:
                back.append(names[k])  # a sign belongs to the name that a column will have
    log = replace(part, outputs=part.outputs @ P.T, inputs=part.inputs @ Q.T)
    words = [f"were {listed(sorted(renamed))} exchanged"] if renamed else []
    words += [f"with the other sign of {listed(back)}"] if back else []
    cure = _cure(dict(sorted(renamed.items())), back, part.factors)
    return Reading(log, range(len(part.output_names)), " and ".join(words), cure)


def _cure(renamed: dict[str, str], back: Sequence[str], factors: Mapping[str, float]) -> str:
    """Returns what to write into the TOML of the log."""
    if not renamed:
        return how_to_turn(back, factors)
    turn = f", and {how_to_turn(back, renamed=True)}" if back else ""
    pairs = [(old, new) for old, new in renamed.items() if renamed[new] == old and old < new]
    text = f"rename {_pairs(renamed)}"
    if 2 * len(pairs) == len(renamed):
        text = f"exchange {', and '.join(f'{a} and {b}' for a, b in pairs)}"
    return f"{text}{how_to_rename(renamed)}{turn}"


def _pairs(renamed: Mapping[str, str]) -> str:
    return listed(f"{old} to {new}" for old, new in renamed.items())


def with_outputs(part: Log, kept: np.ndarray) -> Log:
    """Returns a log with the outputs that a mask keeps: what stands still has no sign or scale."""
    names = tuple(n for n, keep in zip(part.output_names, kept, strict=True) if keep)
    return replace(part, outputs=part.outputs[:, kept], output_names=names, units={}, extras={})


def alike(part: Log, predicted: np.ndarray) -> np.ndarray:
    """Returns cosines of measured and predicted angles (n, k): entry i, j of y_i and ŷ_j."""
    y = part.outputs - part.outputs[0]
    sizes = np.linalg.norm(y, axis=0)[:, None] * np.linalg.norm(predicted, axis=0)
    return np.asarray(y.T @ predicted / sizes)


def off(part: Log, predicted: np.ndarray) -> np.ndarray:
    """Returns ε of each angle of a log beside the twin's (n, k), shape (k,)."""
    return np.asarray(1 - np.diag(alike(part, predicted)))


def is_right(part: Log, predicted: np.ndarray) -> bool:
    """Returns whether every angle is as near to the twin's as one of a right log."""
    return bool((off(part, predicted) <= bounds.RIGHT).all())


def apart(part: Log, predicted: np.ndarray) -> float:
    """Returns γ of the angles of a log and the twin's from its first sample on, shape (n, k) [rad].

    An angle that moves far more than the others is in another unit; it counts as the others do.
    """
    y = part.outputs - part.outputs[0]
    tiny, simulated = np.finfo(float).tiny, np.linalg.norm(predicted, axis=0)
    ratio = np.linalg.norm(y, axis=0) / np.maximum(simulated, tiny)
    usual = np.median(ratio)
    y = y * np.where(ratio > bounds.FAR * usual, usual / np.maximum(ratio, tiny), 1.0)
    sizes = np.linalg.norm(y) * np.linalg.norm(simulated)
    return float(1 - np.sum(y * predicted) / sizes) if sizes > 0 else np.inf
