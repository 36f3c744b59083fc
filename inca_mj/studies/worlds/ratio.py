"""The size of an effect, as the part that a robot without it cannot absorb.

    e(s)  = φ(with s times the effect) − φ(without), all samples and drives, as encoders read it
    S     = ∂φ/∂(base parameters, start pose), by forward differences of the world without effects
    D     = ∂φ/∂(deviations of drives, points and platform), each times its std by the tolerances
    r(s)² = min over a, x of (‖e(s) − S a − D x‖² / σ² + ‖x‖²) / N,         σ the measurement noise

Base parameters may be anything. A part that deviates costs what it is beyond the usual: x is in
units of std. Where all drives are alike and the geometry is exact there is no D, and r is the rms
of (I − S S⁺) e(s) in units of σ.

`sized` solves r(s) = ratio by secants; r(0) = 0, and r is nearly proportional to s mostly. A size
that no robot has is not looked for: what cannot be absorbed may be little of any effect.

    r₁(s) = r(εs)/ε,  ε = 0.01        what is left to first order

S and D are taken without the effect. A large one moves the parameters so far that they hold no
longer, and what r then counts is their curvature, which a robot that is tuned again absorbs: where
r₁ is less than a tenth of r, the effect is a change of parameters and no effect. (A hysteresis of
the drum springs may be all friction: r = 20, r₁ = 0.5.) A part that deviates is a change of
parameters by its nature, and an effect where it deviates by more than parts do.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.model.parameter import ParameterSet
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import POSE
from inca_mj.studies.worlds import layout as at
from inca_mj.studies.worlds.effect import HiddenEffect
from inca_mj.studies.worlds.plant import make_plant
from inca_mj.studies.worlds.sensor import simulate_angles
from inca_mj.studies.worlds.tolerances import EXACT, Tolerances, usual_std

COARSE = 1e-3  # step of these simulations: 4e-8 rad from the world's own, in half its time [s]
NEAR = 0.02  # a ratio this near to the asked one, relative, is good enough
ATTEMPTS = 12
SMALL = 0.01  # of a size: effects of this much are linear in it
LITTLE = 0.1  # of r: where r₁ is less, nearly all of r is curvature


class HiddenAbsorbed:
    """The part that a robot can absorb for one input: by base parameters, start and parts."""

    def __init__(
        self,
        parameters: ParameterSet,
        currents: np.ndarray,
        sampling_time: float,
        names: Sequence[str],
        tolerances: Tolerances = EXACT,
        noise: float = 1.0,
    ) -> None:
        """Take the sensitivities at true parameters, under currents (n, 8) [A].

        `names` are the base parameters, beside the start pose. The noise σ [rad] counts where parts
        may differ by the tolerances.
        """
        self._robot = (parameters, currents, sampling_time)
        self._without = self._angles(parameters, ())
        columns = []
        for name in (*names, *(pose for pose in POSE if pose not in names)):
            h = 1e-5 if name in POSE else 1e-4 * parameters[name].value
            column = self._column(name, h)
            columns.append(column / np.linalg.norm(column))
        # Directions that differ by rounding only (as R_s and k_s do) must not count twice.
        U, size, _ = np.linalg.svd(np.stack(columns, axis=1), full_matrices=False)
        self._basis = U[:, size > 1e-6 * size[0]]
        std = usual_std(parameters, tolerances)
        parts = [self._column(name, 0.1 * s) * (10.0 / noise) for name, s in std.items()]
        D = np.stack(parts, axis=1) if parts else np.zeros((self._without.size, 0))
        # ‖(I − S S⁺) e − D x‖²/σ² + ‖x‖² is least at x = (I + DᵀD)⁻¹ Dᵀ e/σ.
        self._parts = D - self._basis @ (self._basis.T @ D)
        self._inverse = np.linalg.inv(np.eye(D.shape[1]) + self._parts.T @ self._parts)

    def rms(self, effects: Sequence[HiddenEffect]) -> float:
        """Returns the rms of what the robot cannot absorb of these effects, r σ [rad]."""
        e = self._angles(self._robot[0], effects) - self._without
        e -= self._basis @ (self._basis.T @ e)
        seen = self._parts.T @ e
        return float(np.sqrt((e @ e - seen @ self._inverse @ seen) / e.size))

    def is_absorbed(self, effect: HiddenEffect) -> bool:
        """Returns whether nearly nothing is left of an effect to first order, r₁ < r/10."""
        if effect.is_part or not effect.is_smooth or not self._parts.size:
            return False
        return self.rms([effect.scaled(SMALL)]) < SMALL * LITTLE * self.rms([effect])

    def _column(self, name: str, h: float) -> np.ndarray:
        """Returns what a change h of a parameter does to all angles [rad]."""
        moved = self._robot[0].with_values({name: self._robot[0][name].value + h})
        return self._angles(moved, ()) - self._without

    def _angles(self, parameters: ParameterSet, effects: Sequence[HiddenEffect]) -> np.ndarray:
        _, currents, sampling_time = self._robot
        plant = make_plant(parameters, INCA, effects)
        step = None if plant.D[:, at.PLAY].any() else COARSE
        return simulate_angles(plant, effects, currents, sampling_time, step)[1].ravel()


class UnreachedError(InputError):
    """No size that a robot may have of an effect leaves what is asked for."""


def sized(effect: HiddenEffect, absorbed: HiddenAbsorbed, goal: float) -> HiddenEffect:
    """Returns the effect with a size whose unabsorbed rms is `goal` [rad], to 2 %.

    Raises:
        UnreachedError: no size that a robot may have gives it, or a change of parameters would.
    """
    found = _solved(effect, absorbed, goal)
    if absorbed.is_absorbed(found):
        raise UnreachedError(
            f"{effect.name}: other parameters do the same to first order; ask for another effect"
        )
    return found


def _solved(effect: HiddenEffect, absorbed: HiddenAbsorbed, goal: float) -> HiddenEffect:
    """Returns the effect with a size that solves r(s) σ = goal."""
    # Sizes and rms of two trials; the first stands for no effect at all.
    below, above = (0.0, 0.0), (np.inf, np.inf)
    s, r, most = min(1.0, effect.most), 0.0, effect.most
    for _ in range(ATTEMPTS):
        try:
            r = absorbed.rms([effect.scaled(s)])
        except DivergenceError:
            r = np.inf
        if abs(r / goal - 1) < NEAR:
            return effect.scaled(s)
        if r < goal:
            if s == most:
                largest = effect.scaled(s)
                sizes = ", ".join(f"{n} = {getattr(largest, n):.3g}" for n in largest.sizes)
                raise UnreachedError(
                    f"{effect.name}: of the largest size that a robot may have ({sizes}) {r:.3g}"
                    f" rad cannot be absorbed, and {goal:.3g} rad are asked for; ask for another"
                    " ratio, or another effect"
                )
            below = (s, r)
        else:
            above = (s, r)
        s = min(_next(s, r, goal, below, above), most)
    raise UnreachedError(
        f"{effect.name}: no size was found that the base parameters leave {goal:.3g} rad of (the"
        f" last left {r:.3g} rad); start from another size, or ask for another ratio"
    )


def _next(
    s: float, r: float, goal: float, below: tuple[float, float], above: tuple[float, float]
) -> float:
    """Returns the next size: the chord's where both sides are known, else the proportional one."""
    (s_1, r_1), (s_2, r_2) = below, above
    if np.isfinite(r_2):
        if r_1 == 0.0:
            return s_1 + (s_2 - s_1) * goal / r_2
        # In logarithms a power law is straight; the bounds keep one side from creeping.
        part = np.clip(np.log(goal / r_1) / np.log(r_2 / r_1), 0.1, 0.9)
        return float(s_1 * (s_2 / s_1) ** part)
    if np.isfinite(above[0]):
        return 0.5 * (below[0] + above[0])
    return s * min(10.0, goal / r) if r > 0 else 10.0 * s
