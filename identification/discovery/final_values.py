"""The values with which a discovery ends."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from math import isclose

from identification.discovery.result import Discovery
from identification.effects.effect import Effect
from identification.kalman.refit import Refit

BOUND_TOLERANCE = 1e-6  # relative: a value this near to a bound lies on it


def collect_final_values(found: Discovery) -> dict[str, float]:
    """Returns the values of all parameters of the final fit by name, named effects included."""
    return {**found.final.plant.parameters.values(), **found.final.values}


def keep_of_robot(values: Mapping[str, float], effects: Sequence[Effect]) -> dict[str, float]:
    """Returns the values of a robot that hold in every log.

    Args:
        values: values by name.
        effects: the effects that the robot may have; shapes that tell something of one log (what
            an input did before its first sample) are left out.
    """
    of_log = {f"{e.name}.{s.name}" for e in effects for s in e.shapes if s.of_log}
    return {name: value for name, value in values.items() if name not in of_log}


def list_at_bound(fit: Refit, names: Collection[str]) -> list[str]:
    """Returns those of some parameters that lie on a bound of their range.

    A search may keep a value within a narrower range of what is plausible; such a limit is told by
    a finding (`identification.discovery.findings.structure`).

    Args:
        fit: a fit.
        names: of the parameters that are asked for.
    """
    parameters = fit.plant.parameters
    each = ((parameters[n], value) for n, value in fit.values.items() if n in names)
    return [
        p.name for p, value in each
        if any(isclose(value, b, rel_tol=BOUND_TOLERANCE) for b in (p.lower, p.upper) if b)
    ]  # fmt: skip
