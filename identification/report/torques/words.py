"""What torques say of a robot, in sentences."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from identification.quantities import quantity
from identification.report.torques.opinion_words import OTHERWISE, against
from identification.report.torques.tables import (
    SHOWN,
    base_rows,
    called,
    centre_words,
    chance_words,
    far_frictions,
    friction_rows,
    joint_names,
    score_rows,
    size_words,
)
from identification.report.words.effects import DOUBTS
from identification.report.words.errors import listed
from identification.shares import fall_words, percent
from identification.torques.evidence import Evidence
from identification.torques.scores import CHANCE, FAR, PROOF, Score

COLUMNS = "sizes; fall of the mean square on unseen data, its t, chance that luck alone does it"
LATE = 1e-3  # shift of the clocks that is told [s]
LARGE = 3.0  # times the noise, a residual is more than noise
RISEN = 1.05  # factor of a residual that rises
MATTERS = 2.0  # std that a value moves with the band: told


def torque_verdict(evidence: Evidence, model: mujoco.MjModel) -> list[str]:
    """Returns what torques say, the most important sentence first."""
    return [
        *_missing(evidence),
        *_residual(evidence, model),
        *_friction(evidence),
        *_far(evidence),
        *_differences(evidence),
        *_doubts(evidence),
    ]


def torque_text(verdict: Sequence[str], evidence: Evidence) -> str:
    """Returns what a command prints: the verdict, candidates, base parameters and friction."""
    lines = [*verdict, "", f"Candidates ({COLUMNS}):"]
    lines += [f"  {t}: {s}; {f}, {tt}, {c}" for t, s, f, tt, c in score_rows(evidence.scores)]
    lines += ["", "Base parameters (fitted; model; difference in std):"]
    lines += [f"  {n}: {v}; {m}; {off}" for n, v, m, off in base_rows(evidence)]
    lines += ["", "Friction (fitted; model; difference in std):"]
    lines += [f"  {n}: {v}; {m}; {off}" for n, v, m, off in friction_rows(evidence)]
    return "\n".join(lines)


def _missing(evidence: Evidence) -> list[str]:
    on = "records" if evidence.equations.confirms.any() else "blocks of the records"
    if not evidence.scores:
        return ["No candidate differs on these joints from what is fitted already."]
    if not evidence.found:
        first = evidence.scores[0]
        return [
            f"{_none(evidence)}. Of {evidence.asked} candidates the nearest is {called(first)},"
            f" {size_words(first)}: with it the mean square on {on} that no fit has seen"
            f" {fall_words(first.fall)}, t {first.t:.1f}, chance {chance_words(first.chance)}; but"
            f" {against(first.doubt or OTHERWISE, first.chance)}.",
            *_imitated(evidence),
        ]
    out = [] if evidence.named else [f"{_none(evidence)} that physics allows."]
    for k, score in enumerate(evidence.named):
        begins = "They also need" if k else "The torques need"
        if score.missing.is_curve:
            begins += " a force that no law of the catalogue explains,"
        out.append(
            f"{begins} {called(score)}: {size_words(score)}."
            f"{centre_words(score)} The"
            f" mean square of their residual on {on} that no fit has seen {fall_words(score.fall)},"
            f" t {score.t:.1f}, chance {chance_words(score.chance)}."
        )
        if score.t <= PROOF < score.confirmed_t:
            out[-1] += f" On blocks of all records t is {score.confirmed_t:.1f}."
        if score.confirmed_t <= PROOF:
            out[-1] += (
                " Free parameters imitate it, with values far from what was known of them; if they"
                f" are held at what was known, they do not (t {score.held_t:.1f})."
            )
        if k == 0 and (rivals := evidence.rivals[:SHOWN]):
            alike = "; ".join(f"{called(r)}, {size_words(r)}" for r in rivals)
            out[-1] += f" Within chance as good: {alike}."
    return [*out, *_tried(evidence)]


def _none(evidence: Evidence) -> str:
    """Returns that torques prove no effect, apart from the values that later sentences tell."""
    told = []
    if frictions := far_frictions(evidence):
        names = listed([name for name, *_ in frictions])
        told.append(f"frictions that differ from the model ({names})")
    if far := _far_values(evidence):
        names = listed([evidence.final.names[i] for i in far])
        told.append(f"values that are far from what was known of them ({names})")
    if _proven_differences(evidence):
        told.append("a load by which the records differ")
    rest = f"{listed(told)}, told below" if told else "friction, which is always fitted"
    return f"Apart from {rest}, the torques prove no effect"


def _tried(evidence: Evidence) -> list[str]:
    """Returns a sentence on each effect that was added and is no name."""
    out = []
    for s in evidence.tried:
        doubt = evidence.doubts[s.missing.key]
        like = "" if doubt == "beside" else " So something is missing that acts like it."
        out.append(
            f"Tried, and no name: {called(s)}, {size_words(s)}; with it the mean square of their"
            f" residual {fall_words(s.fall)}, t {s.t:.1f}, but {DOUBTS[doubt]}.{like}"
        )
    return out


def _imitated(evidence: Evidence) -> list[str]:
    """Returns a sentence on a candidate that only what was known of free parameters speaks for."""
    likely = [s for s in evidence.scores if s.chance < CHANCE and s.is_plausible]
    if not (likely and evidence.model.inertial):
        return []
    best = min(likely, key=lambda s: (len(s.size), s.chance))
    return [
        f"What was known of the free parameters speaks for {called(best)}"
        f" ({size_words(best)}; chance {chance_words(best.chance)}). But these parameters imitate"
        " it on unseen data: free fewer of them, or record a motion with larger accelerations."
    ]


def _residual(evidence: Evidence, model: mujoco.MjModel) -> list[str]:
    names, units = joint_names(model)
    whole, nominal, final = evidence.unseen
    told = np.sqrt(np.nanmean((final / np.maximum(whole, 1e-300)) ** 2))
    worst = int(np.nanargmax(np.nan_to_num(final / np.maximum(whole, 1e-300))))
    out = [
        "Residual torque (or force) of each joint on data that no fit has seen: "
        + "; ".join(
            f"{n} {quantity(f, unit=u)}" + (f" (model {quantity(m, unit=u)})" if m != f else "")
            for n, f, m, u in zip(names, final, nominal, units, strict=True) if np.isfinite(f)
        )
        + ".",
        *_left(evidence, names),
    ]  # fmt: skip
    if told > 1.1:
        out.append(
            "A rigid arm whose inertial numbers and frictions are all free leaves less, above all"
            f" at {names[worst]} ({quantity(whole[worst], unit=units[worst])}): masses, positions"
            " or inertias of the model are wrong, or something acts like them."
        )
    return out


def _left(evidence: Evidence, names: Sequence[str]) -> list[str]:
    """Returns sentences on residuals in units of noise, on what rises, and on joints by a ratio."""
    _, nominal, final = evidence.unseen
    times = final / np.maximum(evidence.noise, 1e-300)
    has = np.isfinite(times) & (evidence.noise > 0)
    out = []
    if has.any():
        said = [f"{n} {t:.1f}" for n, t, h in zip(names, times, has, strict=True) if h]
        out.append(
            "In units of what the white noise of positions and drives alone would leave, these are"
            f" {listed(said)}."
        )
    if large := [n for n, t, h in zip(names, times, has, strict=True) if h and t > LARGE]:
        out[-1] += f" So something is left at {listed(large)} that the fit does not explain."
    if more := [n for n, a, b in zip(names, nominal, final, strict=True) if b > RISEN * a]:
        out.append(
            f"With what was found more is left of {listed(more)} than without it: what is gained at"
            " other joints is paid for there, so doubt what was found."
        )
    if evidence.passive.any():
        without = listed([n for n, p in zip(names, evidence.passive, strict=True) if p])
        out.append(
            f"No drive acts on {without}. There the motion tells ratios of masses, inertias and"
            " frictions only; their scale is told by the joints with drives that feel them, and by"
            " what was known."
        )
    return out


def _friction(evidence: Evidence) -> list[str]:
    if not (off := far_frictions(evidence)):
        return []
    said = listed([f"{name} {value} (model {model})" for name, value, model in off])
    return [f"Frictions that differ from the model: {said}."]


def _far(evidence: Evidence) -> list[str]:
    final, off = evidence.final, np.abs(evidence.final.base.far)
    return [
        f"{final.names[i]} = {quantity(final.fit.θ[i], final.fit.std[i], final.units[i])} is"
        f" {off[i]:.0f} std from what was known of it: it may stand for something that the model"
        " lacks."
        for i in _far_values(evidence)
    ]


def _far_values(evidence: Evidence) -> list[int]:
    """Returns the places of free values that are far from what was known of them."""
    final = evidence.final
    return [i for i in range(final.inertial) if abs(final.base.far[i]) > FAR]


def _differences(evidence: Evidence) -> list[str]:
    return [
        f"The records differ by a load: {score.missing.title}, {size_words(score)}, with all"
        f" inertial numbers free (t {score.t:.1f}, chance {chance_words(score.chance)})."
        for score in _proven_differences(evidence)
    ]


def _proven_differences(evidence: Evidence) -> list[Score]:
    """Returns the likeliest load of a single record, if it is proven."""
    return [score for score in evidence.differences[:1] if score.is_proven]


def _doubts(evidence: Evidence) -> list[str]:
    moved = np.abs(evidence.other - evidence.whole.fit.θ) / np.maximum(
        evidence.whole.fit.std, 1e-300
    )
    r = len(evidence.base.names)
    worst, many = int(np.argmax(moved)), int(np.sum(moved > MATTERS))
    out = [
        "Where a controller computes the torques from the measured positions, the noise of these is"
        " in the torques too, and std may be too small. If the band of the smooth motion is"
        f" narrower by {percent(1 - 0.6)},"
        + (
            f" {many} of {len(moved)} values move by more than {MATTERS:g} std, most"
            f" {evidence.whole.names[worst]} ({moved[worst]:.1f} std): their std may be too small."
            if many else f" no value moves by more than {moved.max():.1f} std."
        )
    ]  # fmt: skip
    out += _late(evidence)
    std, scale = evidence.whole.fit.std[:r], np.abs(evidence.whole.fit.θ[:r])
    told = int(np.sum(std < np.maximum(scale, np.abs(evidence.base.values)) / 2))
    out.append(f"Of {r} base parameters, {told} are known to better than half of their value.")
    if evidence.gains:
        out.append(
            f"The base parameters are those with {listed(evidence.gains)} at what was known of it:"
            " where all inertial numbers are free, nothing tells a gain from the scale of them all."
        )
    if evidence.inconsistent:
        names = listed([evidence.base.names[k] for k in evidence.inconsistent])
        out.append(
            f"No bodies with positive masses can have {names} within 3 std of the fitted value: the"
            " geometry of the model is wrong, or the model lacks something."
        )
    return out


def _late(evidence: Evidence) -> list[str]:
    """Returns a sentence on inputs that act later or earlier than their stamps say."""
    rows, clocks = evidence.equations.rows, evidence.clocks
    said = [
        f"{quantity(abs(s), float(std), 's')} {'later' if s > 0 else 'earlier'} in {r.name}"
        for r, s, std in zip(rows, clocks.shift, clocks.std, strict=True) if abs(s) > LATE
    ]  # fmt: skip
    if not said:
        return []
    return [f"The inputs act {listed(said)} than their stamps say; the fits correct this."]
