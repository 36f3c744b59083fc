"""Errors of outputs by their unit: one rms over an angle and a way says nothing.

e_g = √mean_j e_j²                 over the outputs j of one unit g
r = √mean_g (e_g/s_g)²             relative to others, over the units: a number without unit
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from identification.logs.log import Log


def by_unit(rms: np.ndarray, log: Log) -> dict[str, float]:
    """Returns the rms over the outputs of each unit, in it, by unit; "" for outputs without one.

    Args:
        rms: of each output, shape (ny,), in its unit.
        log: which outputs they are.
    """
    units = [*output_units(log).values()]
    return {
        unit: float(np.sqrt(np.mean(rms[[u == unit for u in units]] ** 2)))
        for unit in dict.fromkeys(units)
    }


def rms_by_unit(errors: np.ndarray, log: Log) -> dict[str, float]:
    """Returns the rms of errors by unit, in it.

    Args:
        errors: shape (…, ny), in the outputs' units.
        log: which outputs they are.
    """
    return by_unit(np.sqrt(np.mean(errors.reshape(-1, errors.shape[-1]) ** 2, axis=0)), log)


def output_units(log: Log) -> dict[str, str]:
    """Returns the unit of each output by name; "" where it has none."""
    return {name: log.units.get(name, "") for name in log.output_names}


def of_outputs(values: Mapping[str, float], log: Log) -> np.ndarray:
    """Returns for each output the value that is given for its unit, shape (ny,)."""
    return np.array([values[log.units.get(name, "")] for name in log.output_names])


def relative(errors: Mapping[str, float], of: Mapping[str, float]) -> float:
    """Returns errors by unit relative to others, in one number; infinite where these are zero."""
    if not all(of[unit] > 0 for unit in errors):
        return float("inf")
    return float(np.sqrt(np.mean([(e / of[unit]) ** 2 for unit, e in errors.items()])))
