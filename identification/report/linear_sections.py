"""Sections, sentences and tables of a report on linear systems."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from identification.linear.modes import Minimal, Mode, minimal, modes
from identification.linear.system import LinearSystem
from identification.report.linear_figures import eigenvalue_figure, response_figure
from identification.report.linear_json import leading
from identification.report.page import Section, Table

HEAD = ("mode", "frequency [Hz]", "damping", "states that take part most")


def mode_rows(system: LinearSystem) -> list[tuple[str, str, str, str]]:
    """Returns number, frequency, damping and leading states of the modes, those of zero in one row.

    Args:
        system: continuous.
    """
    found = modes(system)
    kept = sum(m.eigenvalue == 0 for m in found)
    rows = [(f"1-{kept}" if kept > 1 else "1", "0", "-", "keep what they are given")] * (kept > 0)
    return rows + [
        (str(k), f"{m.frequency:.4g}", f"{m.damping:.4f}", ", ".join(leading(m, system.states)))
        for k, m in enumerate(found, 1)
        if m.eigenvalue != 0
    ]


def minimal_sentence(small: Minimal, order: int) -> str:
    """Returns a sentence on how many states the minimal realisation has, and what was dropped.

    Args:
        small: the minimal realisation.
        order: number of states of the whole system.
    """
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

    Args:
        systems: continuous.
        labels: what each operating point is called.
        rate: of the samples of the discrete form of the first one [Hz]; none when None.
        units: of inputs and outputs by name, as far as they are known.
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
    """Returns one sentence on the swinging modes.

    Args:
        found: modes of a system.
    """
    swinging = [m for m in found if m.swings]
    if not swinging:
        return "No mode swings."
    low, high = (pick(swinging, key=lambda m: m.frequency) for pick in (min, max))
    return (
        f"{len(swinging)} modes swing, from {low.frequency:.3g} Hz (damping {low.damping:.3f}) to"
        f" {high.frequency:.3g} Hz (damping {high.damping:.3f})."
    )
