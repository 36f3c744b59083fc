"""The information of an experiment as sentences, JSON and sections of reports."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from identification.estimation.information import Information, determinable
from identification.quantities import plain
from identification.report.fit.untold_words import unresolved_words, untold
from identification.report.page.page import Section, Table
from identification.shares import HELD, percent

if TYPE_CHECKING:
    from inca_mj.workflows.excitation import Design

WEAK = 0.5  # a value with a larger relative std says little


def information_verdict(found: Information) -> list[str]:
    """Returns sentences on what can be determined and what cannot."""
    kept, held = determinable(found)
    if held:
        lines = [*lost_sentences(found), f"Hold {' and '.join(held)} fixed."]
        if not kept:
            return lines
        found = found.about(kept)
    else:
        lines = [f"All {found.asked} parameters can be told apart."]
    std = found.std
    worst = int(std.argmax())
    lines.append(
        f"{found.names[worst]} is known worst, to {_amount(found, worst)};"
        f" {found.ranking[0]} best, to {_amount(found, int(std.argmin()))}."
    )
    lines.append(
        f"The worst direction is ({found.found.weakest()}); the condition number is"
        f" {found.condition:.3g}."
    )
    logarithmic = found.logarithmic[: found.asked]
    if weak := [
        n for n, s, r in zip(found.names, std, logarithmic, strict=False) if r and s > WEAK
    ]:
        lines.append(
            f"With this noise the log tells too little about {', '.join(weak)}; excite them more,"
            " or longer."
        )
    return lines


def lost_sentences(found: Information) -> list[str]:
    """Returns sentences on what cannot be determined, because it is not felt or not resolved."""
    inner, lines = found.found, []
    if inner.symmetries:
        known = ", ".join(map(str, found.combinations))
        lost = untold(inner.symmetries, inner.names, {})
        lost = f"T{lost[1:]}" if lost.startswith("the data") else lost
        lines.append(lost + (f"; only {known} can be known." if known else "."))
    if k := len(inner.unresolved):
        count = f"{k}{' more' if lines else ''} direction{'s are' if k > 1 else ' is'}"
        lines.append(count + unresolved_words(inner))
    return lines


def _amount(found: Information, i: int) -> str:
    std = float(found.std[i])
    return percent(std, HELD) if found.logarithmic[i] else f"{std:.2g} SI units"


def information_json(found: Information) -> dict[str, Any]:
    """Returns the numbers as plain values."""
    rows = zip(found.names, found.std, found.conditional, found.logarithmic, strict=False)
    return plain({
        "parameters": {
            name: {"std": std, "conditional_std": alone, "relative": bool(relative)}
            for name, std, alone, relative in rows
        },
        "ranking": found.ranking,
        "strengths": found.found.strengths,
        "worst_direction": found.found.weakest(),
        "condition": found.condition,
        "E": found.e_value,
        "D": found.d_value,
        "A": found.a_value,
        "combinations": [str(c) for c in found.combinations],
        "verdict": information_verdict(found),
    })  # fmt: skip


def information_section(found: Information, about: str) -> Section:
    """Returns the least std of each parameter, if the others are unknown and if they are known."""
    from inca_mj.report.figures import std_figure

    order = [found.names.index(name) for name in found.ranking]
    std, alone = found.std, found.conditional
    return Section(
        "What the experiment can say",
        f"{about}\n\nLeast std of any unbiased estimate (Cramér-Rao), relative to the value, or in"
        " SI units for poses; 'others known' is how well it would be known alone: the ratio is the"
        " price of the company.",
        figures=(("Least std by parameter", std_figure(
            found.ranking, {"others unknown": std[order], "others known": alone[order]})),),
        table=Table(
            ("parameter", "others unknown", "others known", "ratio"),
            tuple(
                (found.names[i], float(std[i]) if np.isfinite(std[i]) else "unknown",
                 float(alone[i]), float(std[i] / alone[i]) if np.isfinite(std[i]) else "–")
                for i in order
            ),
        ),
    )  # fmt: skip


def design_verdict(result: Design) -> list[str]:
    """Returns sentences on how the design compares with the thesis' PRBS."""
    worst, gain = result.worst_gain, result.gain
    names = result.best.found.names
    best, least = int(gain.argmax()), int(gain.argmin())
    lines = [
        f"The worst determined direction is known {worst:.2f} times better than with the thesis'"
        f" PRBS of the same length and noise; {names[best]} gains most ({gain[best]:.2f} times),"
        f" {names[least]} least ({gain[least]:.2f} times).",
        f"The least tension is {result.best.extent.tension:.2f} N, the platform moves"
        f" {result.best.extent.reach:.3f} m and turns {np.degrees(result.best.extent.turn):.0f} deg"
        " at most.",
    ]
    if not result.settings:
        lines.append(f"The search found nothing better than {result.best.name}; raise the budget.")
    elif worst < 1.2:
        lines.append("That gain is small: a longer record does as much.")
    if lost := [n for n, g in zip(names, gain, strict=False) if g < 1]:
        lines.append(f"Known worse than with the PRBS: {', '.join(lost)}; the worst one counts.")
    if result.held:
        lines.append(f"Held fixed, as the PRBS cannot tell them apart: {', '.join(result.held)}.")
    if not result.prbs.allowed:
        lines.append("The thesis' PRBS itself breaks these limits.")
    return lines


def design_json(result: Design) -> dict[str, Any]:
    """Returns the numbers as plain values."""
    far = result.best.extent
    rows = zip(
        result.best.found.names, result.prbs.found.std, result.best.found.std,
        result.gain, result.best.found.logarithmic, strict=False,
    )  # fmt: skip
    return {
        "parameters": {
            name: plain({"std_prbs": a, "std_designed": b, "gain": g, "relative": bool(r)})
            for name, a, b, g, r in rows
        },
        "worst_gain": result.worst_gain,
        "E_prbs": result.prbs.found.e_value,
        "E_designed": result.best.found.e_value,
        "input": {"name": result.best.name, **result.settings},
        "tension_min": far.tension, "reach": far.reach, "turn": far.turn,
        "current_min": far.low, "current_max": far.high,
        "held": list(result.held),
        "evaluations": result.evaluations,
        "inputs": [
            {"name": t.name, "E": t.found.e_value, "allowed": t.allowed,
             "tension_min": t.extent.tension}
            for t in (*result.standard, result.best)
        ],
        "verdict": design_verdict(result),
    }  # fmt: skip


def design_section(result: Design) -> Section:
    """Returns the designed input compared with the thesis' PRBS, and a table of standard inputs."""
    from inca_mj.report.figures import std_figure

    names = result.best.found.names[: result.best.found.asked]
    stds = {"thesis' PRBS": result.prbs.found.std, "designed": result.best.found.std}
    rows = []
    for tried in (*result.standard, result.best):
        least, far = float(tried.extent.tension), float(tried.extent.reach)
        E = float(np.log10(tried.found.e_value)) if tried.found.e_value > 0 else "blind"
        allowed = "yes" if tried.allowed else "no"
        rows.append((tried.name, allowed, least, far, *map(float, 100 * tried.found.std), E))
    recipe = ", ".join(f"{k} {v:.3g}" for k, v in result.settings.items())
    return Section(
        "The effect of the input",
        f"Chosen: {result.best.name}" + (f" ({recipe})" if recipe else "") + ".\n\n"
        "Least std of every parameter (Cramér-Rao), start pose unknown, same length and noise."
        " E is the smallest eigenvalue of the Fisher information. Where cables go slack the"
        " motion is chaotic and the numbers mean nothing: those inputs are not allowed.",
        figures=(("Std under the PRBS and the designed input", std_figure(names, stds)),),
        table=Table(
            ("input", "allowed", "least tension [N]", "reach [m]",
             *(f"std {n} [%]" for n in names), "log10 E"),
            tuple(rows),
        ),
    )  # fmt: skip
