"""How much later the inputs of each record act than their stamps say, as the torques have it.

    τ_u(t - s_r) = Y π + ... + (τ_r - s_r) dτ_u/dt      s_r: shift of the samples of record r
    s_r <- τ_r                                          until it stands still (Gauss, Newton)
    E_0, E_τ, F     sums of squares that curves of the joints leave in blocks that they were not
                    fitted to, without the clocks and with them, and that noise makes

A shift of some milliseconds bends a rate and more, so that its first order alone leaves what looks
like another force, and its size is a tenth too small. So the samples of the inputs are shifted, and
what a servo compares them with stays where it is. A record that confirms has a clock too, which its
own samples tell.

A force that is missing looks a little like any other cause, so that a clock of some std is no shift
yet: a bump of a rail made 25 ms of stamps that were exact. Where much more than noise is left, the
clocks are those beside curves that the joints could have, and are believed only if they take away
most of what these leave, E_τ - F < (E_0 - F)/2.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import mujoco
import numpy as np

from identification.discovery.forces.smooth_force import MUCH_LEFT, takes_most
from identification.effects.effect import CURVE, Effect
from identification.torques.candidates import together
from identification.torques.equations.base import BaseParameters
from identification.torques.equations.equations import Equations, unseen_squares
from identification.torques.equations.others import Others
from identification.torques.fits import CLOCK, FIXED, Fitted, expect_drives, extended
from identification.torques.laws import Laws
from identification.torques.passive import fit_base
from identification.torques.scores import FAR

SMOOTH = ("_speed", "_load", "_position")  # ends of names of curves; over time they follow all
MOST_JOINTS = 3  # whose curves are asked: with those of six joints a fit takes half a minute
ROUNDS = 8  # of shifts
STILL = 1e-5  # move of a shift that is none [s]
STILL_SHARE = 0.1  # of its std, likewise


@dataclass(frozen=True)
class Clocks:
    """How much later the inputs of each of R records act than their stamps say."""

    shift: np.ndarray  # shape (R,) [s]; all zero where they are not believed
    std: np.ndarray  # shape (R,) [s]


def find_clocks(
    model: mujoco.MjModel, measured: Equations, base: BaseParameters, others: Others,
    effects: Sequence[Effect],
) -> Clocks:  # fmt: skip
    """Returns the clocks of all records.

    Args:
        model: of the robot.
        measured: equations of the records.
        base: combinations of inertial numbers.
        others: free parameters that change no inertial number.
        effects: of the catalogue; those that are curves of the joints are asked.
    """
    every = replace(measured, confirms=np.zeros_like(measured.confirms))
    smooth = [e for e in effects if e.name.startswith(CURVE) and e.name.endswith(SMOOTH)]

    def fitted(shift: np.ndarray, has_curves: bool) -> tuple[Equations, Fitted]:
        moved = every.shifted(shift.tolist())
        equations, whole = fit_base(model, moved, base, others.at(moved), has_clocks=True)
        if has_curves:
            laws = Laws(model, equations, expect_drives(model, equations, whole))
            curves = [c for e in smooth for c in laws.of(e)]
            whole = extended(equations, whole, together(curves))
        return equations, whole

    none = np.zeros(len(every.rows))
    clocks, shift, is_doubtful = _standing_still(none, partial(fitted, has_curves=False))
    if smooth and is_doubtful and every.joints <= MOST_JOINTS:
        return _standing_still(shift, partial(fitted, has_curves=True))[0]
    return clocks


def _standing_still(
    begin: np.ndarray, fitted: Callable[[np.ndarray], tuple[Equations, Fitted]]
) -> tuple[Clocks, np.ndarray, bool]:
    """Returns clocks that stand still, the shifts there, and whether these are in doubt.

    They are far from nothing, and much more than noise is left.

    Args:
        begin: shifts with which the search begins, shape (R,) [s].
        fitted: returns the equations and the fit at such shifts.
    """
    shift, none, records = begin, np.zeros(len(begin)), len(begin)
    equations, whole = fitted(none)
    first = whole
    if begin.any():
        equations, whole = fitted(begin)
    for _ in range(ROUNDS):
        at = _of_clocks(whole)
        before, shift = shift, whole.fit.θ[at]
        still = np.maximum(STILL, STILL_SHARE * whole.fit.std[at])
        if (np.abs(shift - before) < still).all():
            break
        equations, whole = fitted(shift)
    at = _of_clocks(whole)
    fit, C = whole.fit, whole.fit.covariance[np.ix_(at, at)]
    n, σ = equations.counts.sum(axis=1), np.nan_to_num(fit.σ)
    noise = float(fit.weights @ (n * equations.noise**2))
    is_much = bool(fit.weights @ (n * σ**2) > MUCH_LEFT**2 * noise)
    # From nothing, and from the mean of all: what all share is known less well than what differs.
    L = np.vstack([np.eye(records), np.eye(records) - 1 / records])
    std = np.sqrt(np.maximum(np.einsum("ij,jk,ik->i", L, C, L), 0.0))
    is_far = is_told = bool((np.abs(L @ shift) > np.maximum(FAR * std, STILL)).any())
    if is_told and is_much:
        after, without = (
            _left(f, fit.weights, held) for f, held in ((whole, []), (first, _of_clocks(first)))
        )
        is_told = takes_most(without, after, noise)
    return Clocks(shift if is_told else none, std[:records]), shift, is_far and is_much


def _of_clocks(whole: Fitted) -> list[int]:
    """Returns the columns of the clocks; other shifts may feel more or fewer of the others."""
    return [k for k, name in enumerate(whole.names) if name.startswith(CLOCK)]


def _left(fitted: Fitted, weights: np.ndarray, held: Sequence[int]) -> float:
    """Returns the weighted squares of blocks by fits that did not see them, sizes held at zero."""
    base = fitted.base
    P = base.P.copy()
    P[held] = FIXED * np.diag(base.fit.H)[held]
    none = np.zeros(base.M.shape[1], bool)
    squares = unseen_squares(base.M, base.fit.weights, P, base.θ_0, none)
    return float(weights @ squares.sum(axis=1))
