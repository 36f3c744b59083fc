"""Steps of the twin in MJX, the JAX version of MuJoCo, without the law of the drives and with it.

MJX has no callbacks and refuses actuators of the type "user". So the currents drive plain motors,
the law is written again in JAX, and a Runge-Kutta step stands around the parts of `mjx.forward`:
positions and velocities first, then the forces of the law in `qfrc_applied`, then accelerations.
The no-load lengths d₀ are kept beside the state:

    T   = max(0, λ (d - d₀)/d₀ + b (ḋ - ḋ₀))         ḋ₀ = -R ω d₀/d
    τ   = -R T + R_s max(0, (R/R_s) T(0) - k_s R_s φ) - b_c tanh(β ω)
"""

from __future__ import annotations

import os
from typing import Any

os.environ.setdefault("XLA_PYTHON_CLIENT_PREALLOCATE", "false")

import jax
import numpy as np
from jax import numpy as jnp
from mujoco import mjx
from mujoco.mjx._src.math import quat_integrate

from gpu.worlds import FIELDS, Worlds, motors
from inca_mj.robot import law as columns

IN_MODEL = tuple(name for name in FIELDS if not name.endswith("_user"))


class Simulator:
    """Steps of worlds side by side.

    Args:
        worlds: what is simulated.
        bits: 32 or 64.
        law: whether the drives have their law.
    """

    def __init__(self, worlds: Worlds, bits: int, law: bool = True) -> None:
        self.type = np.float32 if bits == 32 else np.float64
        with jax.enable_x64(bits == 64):
            self.model, self.data = mjx.put_model(motors()), mjx.make_data(motors())
            run = self._with_law if law else self._bare
            fields = {name: self._cast(worlds.field(name)) for name in FIELDS}
            start = (worlds.start.qpos, worlds.start.qvel, worlds.start.act)
            self.arguments = (fields, *map(self._cast, start), self._cast(worlds.currents))
            many = jax.jit(jax.vmap(run, in_axes=(0, 0, 0, 0, None)))
            self.compiled = many.lower(*self.arguments).compile()
            self.bits = bits

    def __call__(self) -> np.ndarray:
        """Angles of the drums after each step, shape (n, steps, 8) [rad]."""
        return np.asarray(self.run())

    def run(self) -> Any:
        """The same, left on the device, when all is computed."""
        with jax.enable_x64(self.bits == 64):
            return self.compiled(*self.arguments).block_until_ready()

    def _cast(self, array: np.ndarray) -> Any:
        return jnp.asarray(np.asarray(array, self.type))

    def _bare(self, fields: Any, qpos: Any, qvel: Any, act: Any, currents: Any) -> Any:
        model = self.model.replace(**{name: fields[name] for name in IN_MODEL})

        def step(state: Any, current: Any) -> Any:
            data = self.data.replace(qpos=state[0], qvel=state[1], ctrl=current)
            data = mjx.step(model, data)
            return (data.qpos, data.qvel), data.qpos[7:]

        return jax.lax.scan(step, (qpos, qvel), currents)[1]

    def _with_law(self, fields: Any, qpos: Any, qvel: Any, act: Any, currents: Any) -> Any:
        model = self.model.replace(**{name: fields[name] for name in IN_MODEL})
        h = self.type(float(self.model.opt.timestep))
        still = (jnp.zeros_like(qvel), jnp.zeros_like(qvel), jnp.zeros_like(act))
        stages = self._cast([(0, 1 / 6), (0.5, 1 / 3), (0.5, 1 / 3), (1, 1 / 6)])

        def step(state: Any, current: Any) -> Any:
            def stage(before: Any, part: Any) -> Any:
                rate, mean = before
                rate = _rates(model, self.data, fields, _ahead(state, rate, part[0] * h), current)
                return (rate, tuple(m + part[1] * r for m, r in zip(mean, rate, strict=True))), None

            (_, mean), _ = jax.lax.scan(stage, (still, still), stages)
            state = _ahead(state, mean, h)
            return state, state[0][7:]

        return jax.lax.scan(step, (qpos, qvel, act), currents)[1]


def _ahead(state: Any, rate: Any, h: Any) -> Any:
    """A state after a time h at constant rates, the attitude turned as MuJoCo turns it."""
    (qpos, qvel, d_0), (speed, acceleration, d_0_dot) = state, rate
    turned = quat_integrate(qpos[3:7], speed[3:6], h)
    position = jnp.concatenate([qpos[:3] + h * speed[:3], turned, qpos[7:] + h * speed[6:]])
    return position, qvel + h * acceleration, d_0 + h * d_0_dot


def _rates(model: Any, data: Any, fields: Any, state: Any, current: Any) -> Any:
    """Velocity, acceleration and the rate of d₀."""
    qpos, qvel, d_0 = state
    data = data.replace(qpos=qpos, qvel=qvel, ctrl=current)
    data = mjx.fwd_velocity(model, mjx.fwd_position(model, data))
    drives, cables = fields["actuator_user"], fields["tendon_user"]
    R, R_s, k_s, b_c, beta, T_0 = (
        drives[:, c]
        for c in (columns.R, columns.R_S, columns.K_S, columns.B_C, columns.BETA, columns.T_0)
    )
    lambda_, b = cables[:, columns.LAMBDA], cables[:, columns.B]
    d, phi, omega = data.ten_length, qpos[7:], qvel[6:]
    d_0_dot = -R * omega * d_0 / d
    T = jnp.maximum(0, lambda_ * (d - d_0) / d_0 + b * (data._impl.ten_velocity - d_0_dot))
    F_s = jnp.maximum(0, R / R_s * T_0 - k_s * R_s * phi)
    force = -(T @ data._impl.ten_J)
    force = force.at[6:].add(-R * T + R_s * F_s - b_c * jnp.tanh(beta * omega))
    data = mjx.fwd_actuation(model, data.replace(qfrc_applied=force))
    return qvel, mjx.fwd_acceleration(model, data).qacc_smooth, d_0_dot
