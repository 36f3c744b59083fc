"""The thesis' states with the tension of each cable in the place of its no-load length.

    τ = λ (d - d₀)/d₀                                               the elastic part of T (2.31)
    δτ = (λ/d₀) ∂d/∂z δz - (λ d/d₀²) δd₀

In the states of the thesis the pull of a cable is the small difference of two large effects, those
of d and of d₀: where their entries are interpolated one by one, the differences are wrong, and with
them the slow modes. With τ the entries are of moderate size and what belongs together stays so:
φ̇ = ω_m and ṗ = R v make the eight zero eigenvalues exact at every point. So grids use these states.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from identification.linear.system import LinearSystem
from inca_mj.linear.thesis_states import NO_LOAD, STATES
from inca_mj.robot.geometry import DRIVES
from inca_mj.robot.spread import at_drives
from inca_mj.twin.twin import Twin

TENSIONS = tuple(f"tension_{k}" for k in range(1, DRIVES + 1))


def to_tension(system: LinearSystem, lengths: LinearSystem, robot: Twin) -> LinearSystem:
    """Returns a system at rest with tensions for no-load lengths.

    Args:
        system: in the thesis' states, at rest.
        lengths: the same with the lengths d of the eight cables as outputs.
        robot: the twin, whose λ it takes.
    """
    λ = at_drives("lambda", robot.parameters.values())
    d, d_0 = lengths.y, system.x[NO_LOAD]
    S = np.eye(len(system.x))
    S[NO_LOAD] = (λ / d_0)[:, None] * lengths.C
    S[NO_LOAD, NO_LOAD] -= np.diag(λ * d / d_0**2)
    back = np.linalg.inv(S)
    x = system.x.copy()
    x[NO_LOAD] = λ * (d - d_0) / d_0
    names = (*STATES[: NO_LOAD.start], *TENSIONS, *system.states[NO_LOAD.stop :])
    return replace(
        system, A=S @ system.A @ back, B=S @ system.B, C=system.C @ back, states=names, x=x,
        rate=S @ system.rate,
    )  # fmt: skip
