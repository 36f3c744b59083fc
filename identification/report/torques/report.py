"""A report on torques: headline, sections with figures, and what torques say as plain values."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
from matplotlib.figure import Figure

from identification.quantities import alike, plain, quantity
from identification.report.page.headline import Answer, Headline, Tile, capital
from identification.report.page.page import Section, Table
from identification.report.page.style import GREY, INK, SIMULATED, literal, styled
from identification.report.torques.tables import (
    SHOWN,
    base_rows,
    far_frictions,
    friction_rows,
    joint_names,
    score_rows,
)
from identification.report.words.effects import value_with_std
from identification.report.words.errors import listed
from identification.torques.evidence import Evidence
from identification.torques.fits import Fitted
from identification.torques.laws import CURVES
from identification.torques.scores import Score

FEW = 3  # frictions in a headline; of more the count is told
AXES = {
    "_position": "position", "_speed": "speed", "_load": "force of the drives", "_time": "time",
}  # fmt: skip


def torque_sections(evidence: Evidence, model: mujoco.MjModel) -> list[Section]:
    """Returns the sections of a report on torques."""
    rows = evidence.equations.rows
    figures = tuple(
        (f"Torques, {r.name}", torque_figure(evidence, model, k)) for k, r in enumerate(rows)
    )
    drawn = tuple(
        (s.missing.title, force_figure(evidence, s, model))
        for s in evidence.named
        if s.missing.is_curve
    )
    forces = Section(
        "Forces that no law explains",
        "The force that the torques need at a joint, as a curve with a band of two std, and what"
        " each sample leaves to it. Its mean is left out, because a constant force is friction.",
        figures=drawn,
    )
    return [
        *([forces] if drawn else []),
        Section(
            "Torques, joint by joint",
            "The torque that the drives gave, without the part that is known of the model; the same"
            " torque as the final fit predicts it from the measured motion; and the difference of"
            " the two. A curve has a gap where its joint is nearly at rest, because friction may"
            " then be anything below its level.",
            figures=figures,
        ),
        Section(
            "What the model may lack",
            "The fall is that of the mean square on data that the fit has not seen. The chance is"
            " that of the best of all candidates, by blocks that are longer than the memory of the"
            " residual. Of a load, m is the mass, h the mass times the place of its centre, and I"
            " its inertia, both in the frame of the body.",
            table=Table(("candidate", "sizes", "fall", "t", "chance"),
                        tuple(score_rows(evidence.scores))),
        ),
        Section(
            "Base parameters",
            "The combinations of inertial numbers that torques can tell, with all of them free. The"
            " std is by blocks of samples.",
            table=Table(("combination", "fitted", "model", "difference in std"),
                        tuple(base_rows(evidence))),
        ),
        Section(
            "Friction",
            "Beside these base parameters: viscous and Coulomb friction and a constant force.",
            table=Table(("friction", "fitted", "model", "difference in std"),
                        tuple(friction_rows(evidence))),
        ),
    ]  # fmt: skip


@styled
def force_figure(evidence: Evidence, score: Score, model: mujoco.MjModel) -> Figure:
    """Returns a figure of a force that no law explains, against what it depends on."""
    columns, fit = score.missing.columns(), evidence.final.fit
    (j,) = columns.joints or (0,)
    (name, unit), equations = [x[j] for x in joint_names(model)], evidence.equations
    used = equations.stacked("used")[:, j]
    ending = next(end for end in CURVES if score.missing.name.endswith(end))
    x = {"_position": "q", "_speed": "v", "_time": "time"}.get(ending)
    place = equations.stacked(x) if x else equations.stacked("drives").sum(axis=2)
    place = (place if place.ndim == 1 else place[:, j])[used]
    own = f"{score.missing.name}."
    at = [k for k, n in enumerate(evidence.final.names)
          if n.startswith(own) and n.endswith(f", {score.missing.where}")]  # fmt: skip
    S, order = columns.values[used, j], np.argsort(place)
    S = S - S.mean(axis=0)  # what is constant is friction as well, and known to neither
    force, left = (
        S @ fit.θ[at],
        evidence.final.base.y[used, j] - evidence.final.predicted()[used, j],
    )
    std = np.sqrt(np.einsum("ni,ij,nj->n", S, fit.covariance[np.ix_(at, at)], S))
    figure = Figure((6.5, 3.6), layout="constrained")
    ax = figure.subplots()
    ax.plot(
        place, -(force + left), ".", color=GREY, ms=2, alpha=0.4, label="what samples leave to it"
    )
    ax.fill_between(place[order], -(force + 2 * std)[order], -(force - 2 * std)[order],
                    color=SIMULATED, alpha=0.25, lw=0)  # fmt: skip
    ax.plot(place[order], -force[order], color=SIMULATED, lw=1.5, label="curve")
    ax.set_xlabel(literal(f"{AXES[ending]} of {name}"))
    ax.set_ylabel(literal(f"force [{unit}]"))
    ax.legend(fontsize=8)
    return figure


@styled
def torque_figure(evidence: Evidence, model: mujoco.MjModel, record: int) -> Figure:
    """Returns a figure of each joint's torque, measured, predicted and left, against time."""
    names, units = joint_names(model)
    rows = evidence.equations.rows[record]
    first = sum(len(r.time) for r in evidence.equations.rows[:record])
    some = slice(first, first + len(rows.time))
    y = evidence.final.base.y[some]
    predicted = evidence.final.predicted()[some]
    y, predicted = (np.where(rows.used, x, np.nan) for x in (y, predicted))
    figure = Figure((9.5, 1.0 + 1.6 * len(names)), layout="constrained")
    panels = figure.subplots(len(names), sharex=True, squeeze=False)[:, 0]
    for j, ax in enumerate(panels):
        ax.plot(rows.time, y[:, j], color=INK, lw=1.8, alpha=0.5, label="measured")
        ax.plot(rows.time, predicted[:, j], color=SIMULATED, lw=1.0, label="predicted")
        ax.plot(rows.time, (y - predicted)[:, j], color=GREY, lw=0.8, label="difference")
        ax.set_ylabel(literal(f"{names[j]} [{units[j]}]"), fontsize=8)
    panels[-1].set_xlabel("time [s]")
    handles = panels[0].get_legend_handles_labels()
    figure.legend(*handles, loc="outside upper right", ncols=3, fontsize=8)
    return figure


def torque_headline(evidence: Evidence, model: mujoco.MjModel) -> Headline:
    """Returns what torques say in a few words and numbers."""
    tile = _residual(evidence, model)
    if not evidence.named:
        place = "Friction, which is always fitted, is in the table."
        if frictions := far_frictions(evidence):
            told = [f"{name} {value} (model {model})" for name, value, model in frictions[:FEW]]
            told += [f"{len(frictions) - FEW} more"] if len(frictions) > FEW else []
            place = f"apart from frictions that differ from the model: {listed(told)}"
        return Headline("", (Answer("No effect is proven", place, (tile,)),))
    first, *others = (_answer(score) for score in evidence.named)
    first = Answer(first.name, first.place, (*first.tiles, tile))
    return Headline("The torques need", (first, *others))


def _answer(score: Score) -> Answer:
    missing = score.missing
    if missing.is_curve:
        tile = Tile("change", quantity(score.reach, unit=missing.units[0]), missing.phrase)
        return Answer("An unlisted force", missing.where, (tile,))
    value = value_with_std(float(score.size[0]), float(score.std[0]), missing.units[0])
    name = missing.name.replace("_", " ")
    return Answer(capital(name), missing.where, (Tile(missing.sizes[0], value, missing.phrase),))


def _residual(evidence: Evidence, model: mujoco.MjModel) -> Tile:
    """Returns the tile on the joint whose residual the model as it is leaves largest, by its own.

    It is of data that no fit has seen.
    """
    _, nominal, final = evidence.unseen
    names, units = joint_names(model)
    fall = nominal / np.maximum(final, 1e-300)
    j = int(np.argmax(np.where(np.isfinite(fall), fall, -1.0)))
    before, after = alike([float(nominal[j]), float(final[j])], units[j])
    same = nominal[j] == final[j]
    return Tile(
        f"residual of {names[j]} on unseen data",
        after if same else f"{before} → {after}",
        "" if same else "of the model, and with what it needs",
    )


FITS = ("whole", "model", "final")


def evidence_to_json(evidence: Evidence, model: mujoco.MjModel) -> dict[str, Any]:
    """Returns what torques say as plain values."""
    names, units = joint_names(model)
    joints, rows = {}, evidence.equations.rows
    for j, name in enumerate(names):
        of = {
            fit: {
                "residual": float(getattr(evidence, fit).fit.σ[j]),
                "unseen": float(evidence.unseen[k, j]),
            }
            for k, fit in enumerate(FITS)
        }
        joints[name] = {"unit": units[j], **of}
    base, models = _values(evidence.whole), [*evidence.base.values, *evidence.friction]
    for k, one in enumerate(base.values()):
        one |= {"model": models[k]} if k < len(models) else {}
        one["narrower"] = evidence.other[k]
    return plain({
        "joints": joints,
        "base_parameters": base,
        "values": _values(evidence.final),
        "named": [_score(s) for s in evidence.named],
        "tried": [{**_score(s), "doubt": evidence.doubts[s.missing.key]} for s in evidence.tried],
        "scores": [_score(s) for s in evidence.scores[:SHOWN]],
        "rest": [_score(s) for s in evidence.rest[:SHOWN]],
        "differences": [_score(s) for s in evidence.differences[:SHOWN]],
        "asked": evidence.asked,
        "inconsistent": [evidence.base.names[k] for k in evidence.inconsistent],
        "bands": {r.name: r.band for r in rows},
        "clocks": {
            r.name: {"value": s, "std": std, "unit": "s"}
            for r, s, std in zip(rows, evidence.clocks.shift, evidence.clocks.std, strict=True)
        },
    })  # fmt: skip


def _values(fit: Fitted) -> dict[str, dict[str, Any]]:
    rows = zip(fit.names, fit.fit.θ, fit.fit.std, fit.units, strict=False)
    return {name: {"value": value, "std": std, "unit": unit} for name, value, std, unit in rows}


def _score(score: Score) -> dict[str, Any]:
    return {
        "name": score.missing.name, "where": score.missing.where,
        "sizes": {
            n: {"value": v, "std": s, "unit": u}
            for n, v, s, u in zip(score.missing.sizes, score.size, score.std, score.missing.units,
                                  strict=True)
        },
        "shape": {n: v for n, v, _ in score.missing.shape}, "fall": score.fall, "t": score.t,
        "held_t": score.held_t, "chance": score.chance, "proven": score.is_proven,
    }  # fmt: skip
