"""Steps of the twin in MuJoCo Warp, without the law of the drives and with it, in float32.

MuJoCo Warp has callbacks: functions in Python that launch kernels, and a CUDA graph of a step keeps
these. The law is written again as three of them: `passive` pulls the cables, `act_dyn` turns the
no-load lengths, `act_bias` gives the currents. It knows no other floating-point type than float32.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import mujoco
import mujoco_warp as mjw
import numpy as np
import warp as wp

from gpu.worlds import Worlds, motors

wp.config.quiet = True
_INTEGRATOR = int(mujoco.mjtDyn.mjDYN_INTEGRATOR)  # activations of the type "user" do not move
_NONE = int(mujoco.mjtDyn.mjDYN_NONE)


@wp.func
def no_load_rate(drives: wp.array3d[float], w: int, i: int, omega: float, d_0: float, d: float):  # type: ignore[no-untyped-def]
    return -drives[w, i, 1] * omega * d_0 / d


@wp.kernel
def pull(
    drives: wp.array3d[float], cables: wp.array3d[float], d: wp.array2d[float],
    d_dot: wp.array2d[float], nonzeros: wp.array[int], first: wp.array[int],
    column: wp.array[int], J: wp.array2d[float], qpos: wp.array2d[float],
    qvel: wp.array2d[float], d_0: wp.array2d[float], force: wp.array2d[float],
):  # type: ignore[no-untyped-def]  # fmt: skip
    w, i = wp.tid()
    omega, R, R_s = qvel[w, 6 + i], drives[w, i, 1], drives[w, i, 2]
    d_0_dot = no_load_rate(drives, w, i, omega, d_0[w, i], d[w, i])
    strain = (d[w, i] - d_0[w, i]) / d_0[w, i]
    T = wp.max(0.0, cables[w, i, 1] * strain + cables[w, i, 2] * (d_dot[w, i] - d_0_dot))
    F_s = wp.max(0.0, R / R_s * drives[w, i, 6] - drives[w, i, 3] * R_s * qpos[w, 7 + i])
    for a in range(first[i], first[i] + nonzeros[i]):
        wp.atomic_add(force, w, column[a], -T * J[w, a])
    tau = drives[w, i, 4] * wp.tanh(drives[w, i, 5] * omega)
    wp.atomic_add(force, w, 6 + i, R_s * F_s - R * T - tau)


@wp.kernel
def wind(
    drives: wp.array3d[float], d: wp.array2d[float], qvel: wp.array2d[float],
    d_0: wp.array2d[float], d_0_dot: wp.array2d[float],
):  # type: ignore[no-untyped-def]  # fmt: skip
    w, i = wp.tid()
    d_0_dot[w, i] = no_load_rate(drives, w, i, qvel[w, 6 + i], d_0[w, i], d[w, i])


@wp.kernel
def drive(ctrl: wp.array2d[float], force: wp.array2d[float]):  # type: ignore[no-untyped-def]
    w, i = wp.tid()
    force[w, i] = ctrl[w, i]


@wp.kernel
def hold(currents: wp.array2d[float], k: wp.array[int], ctrl: wp.array2d[float]):  # type: ignore[no-untyped-def]
    w, i = wp.tid()
    ctrl[w, i] = currents[k[0], i]


@wp.kernel
def note(qpos: wp.array2d[float], k: wp.array[int], angles: wp.array3d[float]):  # type: ignore[no-untyped-def]
    w, i = wp.tid()
    angles[k[0], w, i] = qpos[w, 7 + i]


@wp.kernel
def count(k: wp.array[int]):  # type: ignore[no-untyped-def]
    k[0] = k[0] + 1


class Simulator:
    """Steps of worlds side by side; on a GPU a step is one CUDA graph.

    Args:
        worlds: what is simulated.
        law: whether the drives have their law.
    """

    def __init__(self, worlds: Worlds, law: bool = True) -> None:
        self.steps, n = len(worlds.currents), len(worlds)
        model = copy.copy(worlds.model if law else motors())
        model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)  # refused
        model.actuator_dyntype[:] = _INTEGRATOR if law else _NONE
        self.model = mjw.put_model(model)
        self.data = mjw.put_data(model, mujoco.MjData(model), nworld=n)
        for name in ("dof_armature", "dof_damping", "body_mass"):
            setattr(self.model, name, wp.array(worlds.field(name), dtype=float))
        gear = worlds.field("actuator_gear").astype(np.float32)
        self.model.actuator_gear = wp.array(gear, dtype=wp.spatial_vector)
        self.start = {
            name: wp.array(getattr(worlds.start, name), dtype=float)
            for name in ("qpos", "qvel", *(("act",) if law else ()))
        }
        self.currents = wp.array(worlds.currents, dtype=float)
        self.k = wp.zeros(1, dtype=int)
        self.angles = wp.zeros((self.steps, n, 8), dtype=float)
        self.shape = (n, 8)
        if law:
            drives, cables = (
                wp.array(worlds.field(f), dtype=float) for f in ("actuator_user", "tendon_user")
            )
            self._hook(drives, cables)
        self._begin()
        self._step()  # compiles
        self.graph = None
        if wp.get_device().is_cuda:
            with wp.ScopedCapture() as capture:
                self._step()
            self.graph = capture.graph

    def __call__(self) -> np.ndarray:
        """Angles of the drums after each step, shape (n, steps, 8) [rad]."""
        self.run()
        return np.moveaxis(self.angles.numpy(), 0, 1)

    def run(self) -> None:
        """The same, left on the device, when all is computed."""
        self._begin()
        once: Callable[[], Any] = self._step
        if self.graph is not None:
            once = lambda: wp.capture_launch(self.graph)  # noqa: E731
        for _ in range(self.steps):
            once()
        wp.synchronize()

    def _begin(self) -> None:
        for name, rows in self.start.items():
            wp.copy(getattr(self.data, name), rows)
        self.k.zero_()

    def _step(self) -> None:
        wp.launch(hold, self.shape, [self.currents, self.k, self.data.ctrl])
        mjw.step(self.model, self.data)
        wp.launch(note, self.shape, [self.data.qpos, self.k, self.angles])
        wp.launch(count, 1, [self.k])

    def _hook(self, drives: Any, cables: Any) -> None:
        def passive(m: Any, d: Any) -> None:
            wp.launch(pull, self.shape, [
                drives, cables, d.ten_length, d.ten_velocity, m.ten_J_rownnz, m.ten_J_rowadr,
                m.ten_J_colind, d.ten_J, d.qpos, d.qvel, d.act, d.qfrc_passive,
            ])  # fmt: skip

        def act_dyn(m: Any, d: Any) -> None:
            wp.launch(wind, self.shape, [drives, d.ten_length, d.qvel, d.act, d.act_dot])

        def act_bias(m: Any, d: Any) -> None:
            wp.launch(drive, self.shape, [d.ctrl, d.actuator_force])

        calls = self.model.callback
        calls.passive, calls.act_dyn, calls.act_bias = passive, act_dyn, act_bias
