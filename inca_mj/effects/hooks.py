"""What a candidate effect may add to the law of a drive, and what it may know when it does.

    i + Δi      current                    L + ΔL     path of the cable, with ∂ΔL/∂r
    R + ΔR      roller radius              T + ΔT     tension
    τ + Δτ      torque on the motor        F          force of a cable on its connector
    ẋ           rate of a state of its own            wrench on the platform

A hook is an njit function of a `Drive` (or a `Platform`) and the tuple of the effect's parameters,
sizes first; it returns what is added. Everything added is zero when the sizes are.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from identification.effects.effect import Effect

# What a hook sees of a drive; NaN where it comes before the quantity is known.
#   time [s]; phi [rad], omega [rad/s] of the motor; i [A] as logged; x own state
#   rx, ry, rz [m] connector minus exit point, in O; d [m] path, d_0 [m] no-load length
#   strain [-], strain_rate [1/s]; T [N], F_s [N]; R, R_s [m], k_s [N/m], b_c [N m], beta [s/rad],
#   K_t [N m/A], lambda_ [N]: the model's numbers, without what effects add to them
Drive: Any = namedtuple(
    "Drive",
    "time phi omega i x rx ry rz d d_0 strain strain_rate T F_s R R_s k_s b_c beta K_t lambda_",
)

# What a hook sees of the platform: position [m], velocity [m/s] in O, body rates [rad/s]
Platform: Any = namedtuple("Platform", "time x y z vx vy vz wx wy wz")

Hook = Callable[..., Any]


@dataclass(frozen=True)
class DriveEffect:
    """An effect and the hooks that make it.

    Attributes:
        effect: name, law, sizes, shapes and places.
        current: (Drive, p) -> Δi [A], of what is known before the tension.
        radius: (Drive, p) -> ΔR [m], of phi and x.
        path: (Drive, p) -> (ΔL [m], ∂ΔL/∂rx, ∂ΔL/∂ry, ∂ΔL/∂rz), of rx, ry, rz.
        tension: (Drive, p) -> ΔT [N].
        torque: (Drive, p) -> Δτ on the motor [N m].
        force: (Drive, p) -> force on the connector (x, y, z), in O [N].
        wrench: (Platform, p) -> force (x, y, z) at the centre of mass [N] and torque (x, y, z)
            [N m], in O.
        rate: (Drive, p) -> ẋ of the effect's own state, which starts at `rest`.
        rest: "zero", or "strain": where x starts.
        inputs: (currents (steps, 8), step [s], p (k, 8)) -> currents; numpy, before the model.
        centre: its sizes x, y, z [m] move the centre of mass; it has no hooks.
    """

    effect: Effect
    current: Hook | None = None
    radius: Hook | None = None
    path: Hook | None = None
    tension: Hook | None = None
    torque: Hook | None = None
    force: Hook | None = None
    wrench: Hook | None = None
    rate: Hook | None = None
    rest: str = "zero"
    inputs: Hook | None = None
    centre: bool = False

    @property
    def name(self) -> str:
        """Canonical name."""
        return self.effect.name

    @property
    def names(self) -> tuple[str, ...]:
        """Its parameters, sizes first, in the order the hooks get them."""
        return (
            *(size.name for size in self.effect.sizes),
            *(shape.name for shape in self.effect.shapes),
        )
