"""The step of the integrator: the usual one, and which ones make sense."""

from __future__ import annotations

from identification.errors import InputError

TIMESTEP = 1e-3  # [s]; RK4 at 1 ms follows the reference to a few microradians


def refuse_step(step: float) -> None:
    """Refuse a largest step with which no simulation makes sense.

    Args:
        step: [s].

    Raises:
        InputError: it is not between 1e-6 and 0.1 s.
    """
    if not 1e-6 <= step <= 0.1:
        raise InputError(f"a step of {step:g} s is not between 1e-6 and 0.1 s; try {TIMESTEP:g}")
