"""The cable law as plain Python callbacks: what the compiled ones are measured against."""

from __future__ import annotations

import mujoco
import numpy as np

from inca_mj.robot import law


def install(model: mujoco.MjModel) -> None:
    """Install Python callbacks that do for this model what `inca_mj.twin.native` does."""
    drives, cables = model.actuator_user, model.tendon_user
    R, R_s, k_s, b_c, beta, T_0 = (
        drives[:, c] for c in (law.R, law.R_S, law.K_S, law.B_C, law.BETA, law.T_0)
    )
    lambda_, b = cables[:, law.LAMBDA], cables[:, law.B]
    tension_at = model.sensor("tension_1").adr[0]
    no_load_at = model.sensor("no_load_length_1").adr[0]
    dense = np.zeros((len(cables), model.nv))

    def no_load_rate(d: mujoco.MjData) -> np.ndarray:
        return -R * d.qvel[6:] * d.act / d.ten_length

    def tension(d: mujoco.MjData) -> np.ndarray:
        strain = (d.ten_length - d.act) / d.act
        return np.maximum(0, lambda_ * strain + b * (d.ten_velocity - no_load_rate(d)))

    def passive(m: mujoco.MjModel, d: mujoco.MjData) -> None:
        T = tension(d)
        mujoco.mju_sparse2dense(dense, d.ten_J, m.ten_J_rownnz, m.ten_J_rowadr, m.ten_J_colind)
        d.qfrc_passive -= T @ dense
        F_s = np.maximum(0, R / R_s * T_0 - k_s * R_s * d.qpos[7:])
        d.qfrc_passive[6:] += -R * T + R_s * F_s - b_c * np.tanh(beta * d.qvel[6:])

    def act_dyn(m: mujoco.MjModel, d: mujoco.MjData, i: int) -> float:
        return -R[i] * d.qvel[6 + i] * d.act[i] / d.ten_length[i]

    def act_bias(m: mujoco.MjModel, d: mujoco.MjData, i: int) -> float:
        return d.ctrl[i]

    def sensor(m: mujoco.MjModel, d: mujoco.MjData, stage: int) -> None:
        if stage == mujoco.mjtStage.mjSTAGE_VEL:
            d.sensordata[tension_at : tension_at + len(T_0)] = tension(d)
            d.sensordata[no_load_at : no_load_at + len(T_0)] = d.act

    mujoco.set_mjcb_passive(passive)
    mujoco.set_mjcb_act_dyn(act_dyn)
    mujoco.set_mjcb_act_bias(act_bias)
    mujoco.set_mjcb_sensor(sensor)


def uninstall() -> None:
    """Release MuJoCo's callbacks."""
    for kind in ("passive", "act_dyn", "act_bias", "sensor"):
        getattr(mujoco, f"set_mjcb_{kind}")(None)
