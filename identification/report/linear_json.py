"""A linear system as plain values, for `--json` and result.json."""

from __future__ import annotations

from typing import Any

import numpy as np

from identification.linear.modes import Mode, minimal, modes
from identification.linear.system import LinearSystem

LEADING = 3  # states that a mode is described by
MATRICES = ("A", "B", "C", "D")


def system_to_json(system: LinearSystem, rate: float | None = None) -> dict[str, Any]:
    """Returns a continuous system as plain values: minimal realisation, modes, discrete form.

    Args:
        system: continuous.
        rate: of the samples of the discrete form [Hz]; none when None.

    Raises:
        InputError: the rate is not above zero.
    """
    small = minimal(system)
    held = None if rate is None else system.discrete(rate)
    return {
        **_matrices(system),
        **{name: list(getattr(system, name)) for name in ("states", "inputs", "outputs")},
        **{name: getattr(system, name).tolist() for name in ("x", "u", "y", "rate")},
        "discrete": None
        if held is None
        else {"A": held.A.tolist(), "B": held.B.tolist(), "sampling_time": held.sampling_time},
        "minimal": {
            **_matrices(small.system),
            "order": len(small.system.A),
            "unreached": small.unreached,
            "unfelt": small.unfelt,
            "tolerance": small.tolerance,
        },
        "modes": [mode_to_json(mode, system.states) for mode in modes(system)],
    }


def mode_to_json(mode: Mode, states: tuple[str, ...]) -> dict[str, Any]:
    """Returns a mode as plain values: its eigenvalue, and the states that take part most.

    Args:
        mode: the mode.
        states: names of the states.
    """
    return {
        "frequency": mode.frequency,
        "damping": mode.damping,
        "eigenvalue": [mode.eigenvalue.real, mode.eigenvalue.imag],
        "leading": leading(mode, states),
    }


def leading(mode: Mode, states: tuple[str, ...]) -> list[str]:
    """Returns the states of the largest participation, the largest first.

    Args:
        mode: the mode.
        states: names of the states.
    """
    order = np.argsort(-mode.participation, kind="stable")[:LEADING]
    return [states[i] for i in order]


def _matrices(system: LinearSystem) -> dict[str, Any]:
    return {name: getattr(system, name).tolist() for name in MATRICES}
