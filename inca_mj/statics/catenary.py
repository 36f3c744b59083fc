"""An elastic cable with weight between two points: the exact curve, and what is usual in its place.

Irvine 1981, Cable Structures, section 1.5, with a Lagrangian coordinate s from the upper to the
lower end, H the horizontal tension, V the vertical force on the upper end, w = ρ g per unstrained
length, V_s = V − w s, T_s = √(H² + V_s²), X and Z the distances from the upper end, across and
down:

    X(s) = H s/λ + (H/w) [asinh(V/H) − asinh(V_s/H)]
    Z(s) = (s/λ) (V − w s/2) + (T_0 − T_s)/w

Both differences lose all digits for a light cable. Written as follows they lose none, and ρ = 0 is
the straight elastic line:

    (T_0 − T_s)/w = s (V + V_s)/(T_0 + T_s)
    asinh(V/H) − asinh(V_s/H) = asinh(q),   q = w s (H² + T_0 T_s − V V_s)/(H² (T_0 + T_s))

Given the ends and d₀, H and V follow from X(d₀) = h and Z(d₀) = v.

What is usual: the parabola of Irvine's section 2 under the weight across the chord, with T the
tension, ℓ = d cos γ the horizontal span of a chord d with slope γ; and Ernst's modulus, the slope
of a sagging cable as that of a straight one (Ernst 1965, Der E-Modul von Seilen unter
Berücksichtigung des Durchhanges):

    sag = ρ g d²/(8 T),   longer by (ρ g ℓ)² d/(24 T²),   λ_eq = λ/(1 + (ρ g ℓ)² λ/(12 T³))
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq, root

from identification.errors import InputError
from inca_mj.robot.parameters import GRAVITY

PLUMB = 1e-6  # a span of less, relative to the chord, is taken to be this
TAUT = 0.3  # H of a taut cable is at least this part of that of the straight line
STEEPEST = 300.0  # h/2a beyond which a cable hangs down on both sides like a curtain
LIGHTEST = 1e-9  # a cable of less has no mass that would give it a shape [kg/m]
SLACK = 1e-12  # a strain of less is none
WIDENINGS = 60  # of a bracket, each by a factor e of H


@dataclass(frozen=True)
class Catenary:
    """A cable that hangs between an exit point A and a connector B."""

    exit: np.ndarray  # A, shape (3,) [m]
    connector: np.ndarray  # B, shape (3,) [m]
    no_load: float  # d₀, its unstrained length [m]
    rho: float  # mass per unstrained length [kg/m]
    lambda_: float  # elastic modulus λ = E S [N]
    H: float  # horizontal tension [N]
    V: float  # vertical force on the upper end, upwards [N]

    @property
    def from_exit(self) -> bool:
        """Tells whether the exit point is the upper end."""
        return bool(self.exit[2] >= self.connector[2])

    def tension(self, s: np.ndarray | float) -> np.ndarray:
        """Returns the tension at unstrained lengths s from the upper end, shape (n,) [m] -> [N]."""
        return np.hypot(self.H, self.V - self.rho * GRAVITY * np.asarray(s, float))

    def points(self, count: int = 51) -> np.ndarray:
        """Returns the curve from the exit point to the connector, shape (count, 3) [m]."""
        s = np.linspace(0, self.no_load, count)
        X, Z = _curve(s, self.H, self.V, self.rho * GRAVITY, self.lambda_)
        upper, lower = (self.exit, self.connector)[:: 1 if self.from_exit else -1]
        along = _direction(lower[:2] - upper[:2])
        curve = np.column_stack([upper[:2] + X[:, None] * along, upper[2] - Z])
        return curve if self.from_exit else curve[::-1]

    def force_on_connector(self) -> np.ndarray:
        """Returns the force of the cable on the platform, in O, shape (3,) [N]."""
        along = _direction(self.exit[:2] - self.connector[:2])
        end = self.V - self.rho * GRAVITY * self.no_load  # vertical force at the lower end
        up = end if self.from_exit else -self.V
        return np.array([*(self.H * along), up])


def hang(
    exit: np.ndarray, connector: np.ndarray, no_load: float, rho: float, lambda_: float
) -> Catenary:
    """Returns the cable of a given unstrained length between two points.

    Args:
        exit: A, shape (3,) [m].
        connector: B, shape (3,) [m].
        no_load: d₀, its unstrained length [m].
        rho: mass per unstrained length [kg/m].
        lambda_: elastic modulus λ = E S [N].

    Raises:
        InputError: a number is not possible, or the cable has no mass and is slack.
    """
    A, B = _checked(exit, connector, no_load, rho, lambda_)
    d, h = float(np.linalg.norm(B - A)), _span(A, B)
    taut, w = lambda_ * (d - no_load) / no_load, rho * GRAVITY
    if rho < LIGHTEST and taut < SLACK * lambda_:
        raise InputError(
            f"a cable of {no_load:g} m without mass is slack over {d:g} m; give a shorter one"
        )
    longer = max(no_load / d - 1, 1e-9)
    guess = np.log(
        h / d * (max(taut, 0.0) + w * h * np.sqrt(1 / (24 * longer)) * (taut < 0) + w * d)
    )

    def wrong(log_H: float) -> float:  # falls where H grows
        return _ends(A, B, float(np.exp(log_H)), rho, lambda_)[1] / no_load - 1

    low = high = float(guess)
    for _ in range(WIDENINGS):
        if wrong(low) >= 0:
            break
        low -= 1.0
    for _ in range(WIDENINGS):
        if wrong(high) <= 0:
            break
        high += 1.0
    if wrong(low) < 0 or wrong(high) > 0:
        raise InputError(
            f"no cable of {no_load:g} m was found to hang over {d:g} m; give a length nearer to"
            " the distance"
        )
    H = float(np.exp(brentq(wrong, low, high, xtol=1e-14, rtol=1e-14)))
    return Catenary(A, B, no_load, rho, lambda_, H, _ends(A, B, H, rho, lambda_)[0])


def pulled(
    exit: np.ndarray, connector: np.ndarray, tension: float, rho: float, lambda_: float
) -> Catenary:
    """Returns the cable with a given tension at the connector [N]; of two, the taut one.

    Raises InputError if a number is not possible, or no taut cable has so little tension.
    """
    A, B = _checked(exit, connector, tension, rho, lambda_)
    d, h = float(np.linalg.norm(B - A)), _span(A, B)

    def wrong(log_H: float) -> float:
        H = float(np.exp(log_H))
        V, d_0 = _ends(A, B, H, rho, lambda_)
        vertical = V - rho * GRAVITY * d_0 if A[2] >= B[2] else V
        return float(np.hypot(H, vertical)) / tension - 1

    low, high = np.log(TAUT * tension * h / d), np.log(tension)
    if rho * GRAVITY * d > tension or wrong(low) >= 0:
        raise InputError(
            f"a cable of {rho:g} kg/m over {d:.3g} m is not taut with {tension:g} N at its"
            " connector; ask for more tension"
        )
    H = float(np.exp(brentq(wrong, low, high, xtol=1e-14, rtol=1e-14)))
    V, d_0 = _ends(A, B, H, rho, lambda_)
    return Catenary(A, B, d_0, rho, lambda_, H, V)


def _ends(
    A: np.ndarray, B: np.ndarray, H: float, rho: float, lambda_: float
) -> tuple[float, float]:
    """Returns V and d₀ of the cable with horizontal tension H between two points."""
    h, v, w = _span(A, B), float(abs(A[2] - B[2])), rho * GRAVITY
    x = w * h / (2 * H)
    if x > STEEPEST:
        return v * w, float("inf")
    wide = np.sinh(x) / x if x > 1e-8 else 1.0
    tall = x / np.tanh(x) if x > 1e-8 else 1.0
    d_0 = float(np.hypot(v, h * wide))
    V = H * v / h * tall + w * d_0 / 2
    T = float(np.hypot(H, V))

    def wrong(y: np.ndarray) -> np.ndarray:
        X, Z = _curve(y[1] * d_0, H, y[0] * T, w, lambda_)
        return np.array([X / h - 1, (Z - v) / d_0])

    y = root(wrong, [V / T, 1 / (1 + T / lambda_)], method="hybr", options={"xtol": 1e-15}).x
    return float(y[0] * T), float(y[1] * d_0)


def _direction(v: np.ndarray) -> np.ndarray:
    """Returns v over its length; zero where it has none."""
    length = float(np.linalg.norm(v))
    return v / length if length > 0 else v


def _span(A: np.ndarray, B: np.ndarray) -> float:
    """Returns the horizontal distance, a little more than none for a plumb cable [m]."""
    return max(float(np.hypot(*(B - A)[:2])), PLUMB * float(np.linalg.norm(B - A)))


def _checked(
    exit: np.ndarray, connector: np.ndarray, size: float, rho: float, lambda_: float
) -> tuple[np.ndarray, np.ndarray]:
    A, B = np.asarray(exit, float), np.asarray(connector, float)
    if A.shape != (3,) or B.shape != (3,) or not np.isfinite([*A, *B, size, rho, lambda_]).all():
        raise InputError("a cable needs two points of three finite numbers, and finite sizes")
    if not (size > 0 and rho >= 0 and lambda_ > 0 and np.linalg.norm(B - A) > 0):
        raise InputError(
            f"there is no cable with length or tension {size:g}, rho {rho:g} kg/m and lambda"
            f" {lambda_:g} N between {A.tolist()} and {B.tolist()} m; give two places, positive"
            " numbers, and a mass that is not negative"
        )
    return A, B


def sag(d: float, tension: float, rho: float) -> float:
    """Returns the sag below the middle of a chord d of a taut cable, ρ g d²/(8 T) [m]."""
    return rho * GRAVITY * d**2 / (8 * tension)


def sag_length(d: float, span: float, tension: float, rho: float) -> float:
    """Returns by how much the parabola is longer than its chord, (ρ g ℓ)² d/(24 T²) [m]."""
    return (rho * GRAVITY * span) ** 2 * d / (24 * tension**2)


def ernst_modulus(span: float, tension: float, rho: float, lambda_: float) -> float:
    """Returns Ernst's equivalent modulus λ/(1 + (ρ g ℓ)² λ/(12 T³)) [N]; ℓ: horizontal span [m]."""
    return lambda_ / (1 + (rho * GRAVITY * span) ** 2 * lambda_ / (12 * tension**3))


def _curve(s, H: float, V: float, w: float, lambda_: float):
    """Returns X and Z at s."""
    V_s = V - w * s
    T_0, T_s = np.hypot(H, V), np.hypot(H, V_s)
    alike = V * V_s > 0  # then T_0 T_s − V V_s loses digits; its conjugate does not
    same = (V**2 + V_s**2 + H**2) / np.where(alike, T_0 * T_s + V * V_s, 1.0)
    apart = (T_0 * T_s - V * V_s) / H**2
    per = (1 + np.where(alike, same, apart)) / (T_0 + T_s)  # q/(w s)
    q = w * s * per
    small = np.abs(q) < 1e-4
    safe = np.where(small, 1.0, q)
    ratio = np.where(small, 1 - q**2 / 6 + 3 * q**4 / 40, np.arcsinh(safe) / safe)  # asinh(q)/q
    X = H * s / lambda_ + H * s * per * ratio
    Z = s / lambda_ * (V - w * s / 2) + s * (V + V_s) / (T_0 + T_s)
    return X, Z
