"""The whole robot with its law as one function, which a GPU runs for one world in each thread.

This is what a GPU path of this project would be: no general simulator, and no call of the host
between the steps. Platform (mass m, inertia I about its centre of mass) and drums in float64, with
the law of `inca_mj.robot.law` compiled from the same source, and MuJoCo's Runge-Kutta step:

    s = p + Q b - a     d = |s|     ḋ = sᵀ (v + Q ω × Q b)/d
    m v̇ = m g - Σ T s/d            I ω̇ = Qᵀ Σ (Q b × -T s/d) - ω × I ω
    J ω̇_m = K_t i - R T + R_s F_s - b_v ω_m - τ_c        ḋ₀ = -R ω_m d₀/d

It takes the platform's frame at its centre of mass, axes of the frame that are the principal ones,
no candidate effects, and no limits of the currents. numba compiles it for a processor as well,
where a test compares it with the twin.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin, sqrt
from typing import Any

import numpy as np
from numba import njit

from gpu.worlds import Worlds
from inca_mj.robot import law

# a state: p 0:3, attitude 3:7, v 7:10, ω 10:13, φ 13:21, ω_m 21:29, d₀ 29:37
STATE, RATE = 37, 36
NUMBERS = 17  # of a drive: R R_s k_s b_c β T(0) K_t J b_v λ b, exit point a, connector b
THREADS = 32  # in a block


def simulator(compiled: Callable[..., Any]) -> Any:
    """A function that runs one world, by what compiles a function of Python for the device."""
    no_load_rate, tension, spring_force, coulomb = (
        compiled(getattr(f, "py_func", f))
        for f in (law.no_load_rate, law.tension, law.spring_force, law.coulomb_friction)
    )

    @compiled
    def rates(y, platform, drives, u, w, dy):  # type: ignore[no-untyped-def]
        """ẏ without the velocities themselves: dy is v, ω, ω_m, then their rates, then ḋ₀."""
        n = 1.0 / sqrt(y[3] * y[3] + y[4] * y[4] + y[5] * y[5] + y[6] * y[6])
        a, b, c, e = y[3] * n, y[4] * n, y[5] * n, y[6] * n
        Q11, Q12, Q13 = a * a + b * b - c * c - e * e, 2 * (b * c - a * e), 2 * (b * e + a * c)
        Q21, Q22, Q23 = 2 * (b * c + a * e), a * a - b * b + c * c - e * e, 2 * (c * e - a * b)
        Q31, Q32, Q33 = 2 * (b * e - a * c), 2 * (c * e + a * b), a * a - b * b - c * c + e * e
        wx, wy, wz = y[10], y[11], y[12]
        ox = Q11 * wx + Q12 * wy + Q13 * wz
        oy = Q21 * wx + Q22 * wy + Q23 * wz
        oz = Q31 * wx + Q32 * wy + Q33 * wz
        fx = fy = fz = tx = ty = tz = 0.0
        for i in range(8):
            bx, by, bz = drives[14, i, w], drives[15, i, w], drives[16, i, w]
            rx = Q11 * bx + Q12 * by + Q13 * bz
            ry = Q21 * bx + Q22 * by + Q23 * bz
            rz = Q31 * bx + Q32 * by + Q33 * bz
            sx = y[0] + rx - drives[11, i, w]
            sy = y[1] + ry - drives[12, i, w]
            sz = y[2] + rz - drives[13, i, w]
            d = sqrt(sx * sx + sy * sy + sz * sz)
            sx, sy, sz = sx / d, sy / d, sz / d
            d_dot = sx * (y[7] + oy * rz - oz * ry)
            d_dot += sy * (y[8] + oz * rx - ox * rz) + sz * (y[9] + ox * ry - oy * rx)
            phi, omega, d_0, R, R_s = (
                y[13 + i], y[21 + i], y[29 + i], drives[0, i, w], drives[1, i, w],
            )  # fmt: skip
            d_0_dot = no_load_rate(d, d_0, omega, R)
            T = tension(d, d_dot, d_0, d_0_dot, drives[9, i, w], drives[10, i, w], 0.0)
            F_s = spring_force(phi, R, R_s, drives[2, i, w], drives[5, i, w])
            fx, fy, fz = fx - T * sx, fy - T * sy, fz - T * sz
            tx -= T * (ry * sz - rz * sy)
            ty -= T * (rz * sx - rx * sz)
            tz -= T * (rx * sy - ry * sx)
            torque = drives[6, i, w] * u[i] - R * T + R_s * F_s - drives[8, i, w] * omega
            torque -= coulomb(omega, drives[3, i, w], drives[4, i, w])
            dy[6 + i], dy[20 + i], dy[28 + i] = omega, torque / drives[7, i, w], d_0_dot
        m, Ix, Iy, Iz = platform[0, w], platform[1, w], platform[2, w], platform[3, w]
        for k in range(6):
            dy[k] = y[7 + k]
        dy[14], dy[15], dy[16] = fx / m, fy / m, fz / m + platform[4, w]
        dy[17] = (Q11 * tx + Q21 * ty + Q31 * tz - (Iz - Iy) * wy * wz) / Ix
        dy[18] = (Q12 * tx + Q22 * ty + Q32 * tz - (Ix - Iz) * wz * wx) / Iy
        dy[19] = (Q13 * tx + Q23 * ty + Q33 * tz - (Iy - Ix) * wx * wy) / Iz

    @compiled
    def ahead(y, dy, h, out):  # type: ignore[no-untyped-def]
        """The state after a time h at constant rates, the attitude turned by the angle h |ω|."""
        for k in range(3):
            out[k], out[7 + k], out[10 + k] = (
                y[k] + h * dy[k], y[7 + k] + h * dy[14 + k], y[10 + k] + h * dy[17 + k],
            )  # fmt: skip
        for i in range(8):
            out[13 + i], out[21 + i] = y[13 + i] + h * dy[6 + i], y[21 + i] + h * dy[20 + i]
            out[29 + i] = y[29 + i] + h * dy[28 + i]
        speed = sqrt(dy[3] * dy[3] + dy[4] * dy[4] + dy[5] * dy[5])
        half, c = 0.5 * h * speed, 0.0
        if speed > 1e-15:
            c = sin(half) / speed
        e, x, yy, z = cos(half), c * dy[3], c * dy[4], c * dy[5]
        a, b, f, g = y[3], y[4], y[5], y[6]
        out[3], out[4] = a * e - b * x - f * yy - g * z, a * x + b * e + f * z - g * yy
        out[5], out[6] = a * yy - b * z + f * e + g * x, a * z + b * yy - f * x + g * e

    @compiled
    def run(w, start, platform, drives, currents, h, angles, y, at, dy, mean):  # type: ignore[no-untyped-def]
        """World w; its angles go into angles[step, i, w]; the last four are room to work in."""
        for k in range(STATE):
            y[k] = start[k, w]
        for step in range(len(currents)):
            rates(y, platform, drives, currents[step], w, dy)
            for k in range(RATE):
                mean[k] = dy[k] / 6.0
            for stage in range(3):
                ahead(y, dy, h if stage == 2 else 0.5 * h, at)
                rates(at, platform, drives, currents[step], w, dy)
                for k in range(RATE):
                    mean[k] += dy[k] / (6.0 if stage == 2 else 3.0)
            ahead(y, mean, h, at)
            for k in range(STATE):
                y[k] = at[k]
            for i in range(8):
                angles[step, i, w] = y[13 + i]

    return run


def arguments(worlds: Worlds) -> tuple[Any, ...]:
    """Start, platform, drives, currents and step of `run`; the last index is the world."""
    model, geometry = worlds.model, worlds.robot.geometry
    qpos, qvel, act = (np.asarray(getattr(worlds.start, f)) for f in ("qpos", "qvel", "act"))
    start = np.concatenate([qpos[:, :7], qvel[:, :6], qpos[:, 7:], qvel[:, 6:], act], axis=1).T
    user, cables = worlds.field("actuator_user"), worlds.field("tendon_user")
    J = worlds.field("dof_armature")[:, 6:] + model.body_inertia[2, 2]
    drives = [user[..., c] for c in (law.R, law.R_S, law.K_S, law.B_C, law.BETA, law.T_0)]
    drives += [worlds.field("actuator_gear")[..., 0], J, worlds.field("dof_damping")[:, 6:]]
    drives += [cables[..., law.LAMBDA], cables[..., law.B]]
    drives += [np.broadcast_to(x, J.shape) for x in (*geometry.A.T, *geometry.B.T)]
    n = len(worlds)
    body = [worlds.field("body_mass")[:, 1], *(np.full(n, I) for I in model.body_inertia[1])]
    body.append(np.full(n, model.opt.gravity[2]))
    arrays = (start, np.array(body), np.moveaxis(np.array(drives), 1, 2), worlds.currents)
    return (*map(np.ascontiguousarray, arrays), float(model.opt.timestep))


def on_processor(worlds: Worlds) -> np.ndarray:
    """Angles of the drums after each step by the same function, shape (n, steps, 8) [rad]."""
    run, given, n = simulator(njit), arguments(worlds), len(worlds)
    angles = np.empty((len(worlds.currents), 8, n))
    room = [np.empty(size) for size in (STATE, STATE, RATE, RATE)]
    for w in range(n):
        run(w, *given, angles, *room)
    return np.moveaxis(angles, 2, 0)


class Simulator:
    """Steps of worlds side by side on a GPU, all in one kernel."""

    def __init__(self, worlds: Worlds) -> None:
        from numba import config, cuda

        config.CUDA_LOW_OCCUPANCY_WARNINGS = 0  # few worlds are the question

        world = simulator(cuda.jit(device=True))

        @cuda.jit
        def every(start, platform, drives, currents, h, angles):  # type: ignore[no-untyped-def]
            w = cuda.grid(1)
            y, at = cuda.local.array(STATE, np.float64), cuda.local.array(STATE, np.float64)
            dy, mean = cuda.local.array(RATE, np.float64), cuda.local.array(RATE, np.float64)
            if w < start.shape[1]:
                world(w, start, platform, drives, currents, h, angles, y, at, dy, mean)

        *arrays, h = arguments(worlds)
        self.given = (*map(cuda.to_device, arrays), h)
        self.angles = cuda.device_array((len(worlds.currents), 8, len(worlds)))
        self.launch = every[-(-len(worlds) // THREADS), THREADS]
        self.wait = cuda.synchronize
        self.run()  # compiles

    def __call__(self) -> np.ndarray:
        """Angles of the drums after each step, shape (n, steps, 8) [rad]."""
        self.run()
        return np.moveaxis(self.angles.copy_to_host(), 2, 0)

    def run(self) -> None:
        """The same, left on the device, when all is computed."""
        self.launch(*self.given, self.angles)
        self.wait()
