"""Sections, sentences and tables of a report on linear systems."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from identification.linear.modes import Minimal, Mode, minimal, modes
from identification.linear.system import LinearSystem
from identification.quantities import per, plain_fields
from identification.report.page.page import Section, Table
from identification.report.page.style import GREY, INK, SERIES, literal, styled

LEADING = 3  # states that a mode is described by
MATRICES = ("A", "B", "C", "D")


def system_to_json(system: LinearSystem, rate: float | None = None) -> dict[str, Any]:
    """Returns a continuous system as plain values: minimal realisation, modes, discrete form.

    The discrete form has the rate of the samples [Hz]; there is none without a rate.
    """
    small = minimal(system)
    discrete = None if rate is None else system.discrete(rate)
    return {
        **plain_fields(system, *MATRICES, "states", "inputs", "outputs", "x", "u", "y", "rate"),
        "discrete": discrete and plain_fields(discrete, "A", "B", "sampling_time"),
        "minimal": {
            **plain_fields(small.system, *MATRICES),
            "order": len(small.system.A),
            **plain_fields(small, "unreached", "unfelt", "tolerance"),
        },
        "modes": [
            {
                "frequency": m.frequency, "damping": m.damping,
                "eigenvalue": [m.eigenvalue.real, m.eigenvalue.imag],
                "leading": leading(m, system.states),
            }
            for m in modes(system)
        ],
    }  # fmt: skip


def leading(mode: Mode, states: tuple[str, ...]) -> list[str]:
    """Returns the states of the largest participation, the largest first."""
    order = np.argsort(-mode.participation, kind="stable")[:LEADING]
    return [states[i] for i in order]


POINTS = 200  # of a frequency response
BEYOND = 10.0  # factor by which it reaches beyond the slowest and the fastest mode
WIDEST = 1e8  # ratio of its highest frequency to its lowest


@styled
def eigenvalue_figure(systems: Sequence[LinearSystem], labels: Sequence[str]) -> Figure:
    """Returns a figure of frequency and damping ratio of decaying modes, one colour per system."""
    figure = Figure((7.5, 3.4), layout="constrained")
    axis = figure.subplots()
    for k, (system, label) in enumerate(zip(systems, labels, strict=True)):
        moving = [m for m in modes(system) if m.damping is not None]
        axis.semilogx(
            [m.frequency for m in moving], [m.damping for m in moving], "o", ms=5, alpha=0.7,
            color=SERIES[k % len(SERIES)], label=literal(label),
        )  # fmt: skip
    axis.set(xlabel="|λ|/2π [Hz]", ylabel="damping ratio")
    axis.axhline(0, color=GREY, lw=0.8)
    if len(systems) > 1:
        axis.legend(fontsize=8)
    return figure


@styled
def response_figure(
    system: LinearSystem,
    discrete: LinearSystem | None = None,
    units: Mapping[str, str] | None = None,
) -> Figure:
    """Returns a figure of the responses of outputs to inputs of the same number, over frequency.

    A discrete system, for inputs that are held, is shown up to half its rate. Units are of inputs
    and outputs by name, as far as they are known.
    """
    rates = [m.frequency for m in modes(system) if m.frequency > 0] or [1.0]
    top = max(rates) * BEYOND
    f = np.geomspace(max(min(rates) / BEYOND, top / WIDEST), top, POINTS)
    pairs = list(zip(system.outputs, system.inputs, SERIES, strict=False))
    figure = Figure((7.5, 5.4), layout="constrained")
    magnitude, phase = figure.subplots(2, 1, sharex=True)
    for of, style in ((system, "-"), (discrete, "--")):
        at = f if of is None or of.sampling_time is None else f[f < 0.5 / of.sampling_time]
        if of is None or not len(at):
            continue
        G = of.response(at)
        for k, (output, driven, color) in enumerate(pairs):
            label = literal(f"{output} / {driven}") if style == "-" else None
            magnitude.loglog(at, np.abs(G[:, k, k]), style, color=color, lw=1, label=label)
            turned = np.degrees(np.unwrap(np.angle(G[:, k, k])))
            phase.semilogx(at, turned, style, color=color, lw=1)
    known = units or {}
    told = {(known.get(output, ""), known.get(driven, "")) for output, driven, _ in pairs}
    over, under = told.pop() if len(told) == 1 else ("", "")
    unit = per(over, under) if over and under else "unit of the output / unit of the input"
    magnitude.set_ylabel(literal(f"magnitude [{unit}]"))
    phase.set(xlabel="frequency [Hz]", ylabel="phase [°]")
    title = "dashed: inputs held between samples" if discrete is not None else ""
    magnitude.set_title(title, loc="left", color=INK)
    figure.legend(loc="outside lower center", ncols=4, fontsize=7)
    return figure


HEAD = ("mode", "frequency [Hz]", "damping", "states that take part most")


def mode_rows(system: LinearSystem) -> list[tuple[str, str, str, str]]:
    """Returns number, frequency, damping and leading states of modes, those of zero in one row."""
    found = modes(system)
    kept = sum(m.eigenvalue == 0 for m in found)
    rows = [(f"1-{kept}" if kept > 1 else "1", "0", "-", "keep what they are given")] * (kept > 0)
    return rows + [
        (str(k), f"{m.frequency:.4g}", f"{m.damping:.4f}", ", ".join(leading(m, system.states)))
        for k, m in enumerate(found, 1)
        if m.eigenvalue != 0
    ]


def minimal_sentence(small: Minimal, order: int) -> str:
    """Returns a sentence on the size of a minimal realisation of a system of `order` states."""
    return (
        f"The minimal realisation has {len(small.system.A)} of {order} states: no input reaches"
        f" {small.unreached} and no output feels {small.unfelt} of the others (staircase of"
        f" orthogonal transformations, ranks to {small.tolerance:g} of the norm)."
    )


def linear_sections(
    systems: Sequence[LinearSystem],
    labels: Sequence[str],
    rate: float | None,
    units: Mapping[str, str] | None = None,
) -> list[Section]:
    """Returns the sections of a report on linear systems at some operating points.

    Labels call the points; a discrete form of the first one has the rate [Hz], if there is one.
    Units are of inputs and outputs by name, as far as they are known.
    """
    first = systems[0]
    held = None if rate is None else first.discrete(rate)
    small = minimal(first)
    return [
        Section(
            f"The modes, {labels[0]}",
            f"{minimal_sentence(small, len(first.A))}\n\nA pair of conjugate eigenvalues is one"
            " mode; damping 1 is a decay without swinging, and below 0 it grows.",
            table=Table(HEAD, tuple(mode_rows(first))),
            figures=(("Eigenvalues", eigenvalue_figure(systems, labels)),),
        ),
        Section(
            f"From inputs to outputs, {labels[0]}",
            figures=(("Frequency response", response_figure(first, held, units)),),
        ),
    ]


def slowest_and_fastest(found: Sequence[Mode]) -> str:
    """Returns one sentence on the swinging modes."""
    swinging = [m for m in found if m.swings]
    if not swinging:
        return "No mode swings."
    low, high = (pick(swinging, key=lambda m: m.frequency) for pick in (min, max))
    return (
        f"{len(swinging)} modes swing, from {low.frequency:.3g} Hz (damping {low.damping:.3f}) to"
        f" {high.frequency:.3g} Hz (damping {high.damping:.3f})."
    )
