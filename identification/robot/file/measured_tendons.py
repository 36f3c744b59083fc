"""Joints whose positions the measured lengths of tendons tell.

    l_i(q) = measured length of tendon i,     c_k(q) = 0 of each equality

q is found sample by sample with Gauss-Newton steps, from where the sample before was; the first
one begins in the pose of the model's file, which chooses among several that have these lengths.
Joints that the outputs name themselves are known, as the one between the base and a link is where
an encoder at the base measures the sum of two joints over a belt. The joints that tendons tell are
then outputs like others. Noise of lengths becomes noise of angles that neighbouring joints share.

A length of MuJoCo is that of the whole path (spatial), or the weighted sum of joint positions
(fixed). A drum that counts from zero needs its offset: `joint = ...` cannot say it, so such a
column is refused with the lengths that the model has.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from identification.errors import InputError
from identification.logs.log import Log
from identification.logs.names import listed
from identification.robot.file.completed import add_position, position_of
from identification.robot.file.file import RobotFile
from identification.runtime.engine import quiet

LENGTH = mujoco.mjtSensor.mjSENS_TENDONPOS
STEPS = 20  # Gauss-Newton steps in a sample at most
NEAR = 1e-10  # step that ends them [m or rad]
FAR = 0.05  # of the motion of the lengths: what a pose may leave unexplained
POSES, SPREAD = 4, 0.1  # random poses about the model's that show what moves a tendon [m or rad]
_SCALAR = (int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE))
_POSITION = int(mujoco.mjtSensor.mjSENS_JOINTPOS)
_SHAPES = ("site/", "geom/", ".pos[", ".quat[", ".axis[")  # in paths that move where tendons run


@dataclass(frozen=True)
class MeasuredTendons:
    """Tendons that a log measures, and the joints that they tell."""

    sensors: tuple[str, ...]  # of lengths, as columns of the log are called
    joints: tuple[str, ...]  # as their sensors of positions are called


def with_measured_joints(spec: mujoco.MjSpec, file: RobotFile) -> tuple[str, ...]:
    """Add sensors of the joints that measured tendons tell; say so."""
    if not any(s.type == LENGTH and s.name in file.outputs for s in spec.sensors):
        return ()
    model = spec.copy().compile()
    joints = _moved_joints(model, _lengths(model, file))
    known, actuators = {*_positions(model)}, {actuator.name for actuator in spec.actuators}
    for joint in joints:
        if joint not in known:
            add_position(spec, joint, position_of(joint, actuators))
    tendons = measured_tendons(spec.copy().compile(), file)
    return (
        f"The positions of {listed(tendons.joints)} are those at which the tendons have the lengths"
        f" {listed(tendons.sensors)}.",
    )


def measured_tendons(model: mujoco.MjModel, file: RobotFile) -> MeasuredTendons:
    """Returns the tendons that a robot's file has as outputs, and the joints that they tell."""
    sensors = _lengths(model, file)
    if not sensors:
        return MeasuredTendons((), ())
    moves = [n for n in file.free if any(
        part in str(file.records.get(n, {}).get("path", n)) for part in _SHAPES)]  # fmt: skip
    if moves:
        raise InputError(
            f"{file.path} frees {moves[0]}, which moves where tendons run, and joint positions are"
            f" computed from the lengths {listed(sensors)} before a fit; hold it, or measure the"
            " joints"
        )
    at = _positions(model)
    moved = [at[j] for j in _moved_joints(model, sensors)]
    told = tuple(name for name in moved if name not in file.outputs)
    if not told:
        raise InputError(
            f"{file.path} has as outputs the lengths {listed(sensors)} and the positions of all"
            f" joints that change them, {listed(moved)}, so that one of these has nothing to tell;"
            " leave it out of outputs"
        )
    return MeasuredTendons(sensors, told)


@quiet()
def joint_positions(
    model: mujoco.MjModel, tendons: MeasuredTendons, log: Log, names: Sequence[str]
) -> Log:
    """Returns a log with joint positions in the place of the lengths of tendons.

    Args:
        model: with sensors of both.
        tendons: what was measured, and the joints.
        log: its outputs are lengths of the tendons and positions of other joints.
        names: of the outputs of the log that is returned, in order.

    Raises:
        InputError: lengths and known joints do not tell the others, or no pose has these lengths.
    """
    model, data = copy.copy(model), mujoco.MjData(model)
    for flag in ("CONTACT", "LIMIT", "FRICTIONLOSS"):
        model.opt.disableflags |= int(getattr(mujoco.mjtDisableBit, f"mjDSBL_{flag}"))
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    columns = {name: k for k, name in enumerate(log.output_names)}
    wanted = log.outputs[:, [columns[name] for name in tendons.sensors]]
    ids = [int(model.sensor(name).objid[0]) for name in tendons.sensors]
    known = {
        int(model.sensor(name).objid[0]): k
        for name, k in columns.items()
        if int(model.sensor(name).type[0]) == _POSITION
    }
    q_at, places = [*known], [int(model.jnt_qposadr[j]) for j in known]
    fixed = {int(model.jnt_dofadr[j]) for j in q_at}
    told = [int(model.sensor(name).objid[0]) for name in tendons.joints]
    dofs = _felt(model, ids, fixed)
    found, left = np.zeros((len(log), len(told))), np.zeros(wanted.shape)
    for k in range(len(log)):
        data.qpos[places] = log.outputs[k, [known[j] for j in q_at]]
        for _ in range(STEPS):
            mujoco.mj_fwdPosition(model, data)
            J = np.vstack(
                [_tendon_rows(model, data)[ids], data.efc_J.reshape(-1, model.nv)[: data.ne]]
            )
            r = np.concatenate([wanted[k] - data.ten_length[ids], -data.efc_pos[: data.ne]])
            if k == 0:
                _refuse_untold(J[:, dofs], tendons)
            step = np.zeros(model.nv)
            step[dofs] = np.linalg.lstsq(J[:, dofs], r, rcond=None)[0]
            mujoco.mj_integratePos(model, data.qpos, step, 1.0)
            if np.abs(step).max() < NEAR:
                break
        mujoco.mj_fwdPosition(model, data)
        left[k] = wanted[k] - data.ten_length[ids]
        found[k] = data.qpos[model.jnt_qposadr[told]]
    _refuse_impossible(model, tendons, log, wanted, left)
    every = {**dict(zip(log.output_names, log.outputs.T, strict=True)),
             **dict(zip(tendons.joints, found.T, strict=True))}  # fmt: skip
    outputs = np.stack([every[name] for name in names], axis=1)
    return replace(log, outputs=outputs, output_names=tuple(names))


def _refuse_untold(J: np.ndarray, tendons: MeasuredTendons) -> None:
    """Refuse lengths that leave joints free."""
    rank = int(np.linalg.matrix_rank(J, tol=1e-6 * np.linalg.norm(J, 2)))
    if rank < J.shape[1]:
        raise InputError(
            f"the lengths {listed(tendons.sensors)} tell {rank} of the {J.shape[1]} ways to move of"
            f" {listed(tendons.joints)}; name sensors of joints or of further tendons under outputs"
        )


def _refuse_impossible(
    model: mujoco.MjModel, tendons: MeasuredTendons, log: Log, wanted: np.ndarray, left: np.ndarray
) -> None:
    """Refuse lengths with which the model has no pose."""
    k = int(np.argmax(np.sqrt((left**2).mean(axis=0)) / wanted.std(axis=0)))
    if not np.sqrt((left[:, k] ** 2).mean()) < FAR * wanted[:, k].std():
        name = tendons.sensors[k]
        data = mujoco.MjData(model)
        mujoco.mj_fwdPosition(model, data)
        has = float(data.ten_length[int(model.sensor(name).objid[0])])
        raise InputError(
            f"no pose of the model has the lengths of log {log.name!r}: {name} is"
            f" {wanted[0, k]:.4g} m at first and {has:.4g} m as the model's file has it; see"
            " whether its column counts from another zero, or is in another unit"
        )


def _lengths(model: mujoco.MjModel, file: RobotFile) -> tuple[str, ...]:
    """Returns the sensors of lengths of tendons among the outputs of a file."""
    kinds = {model.sensor(i).name: int(model.sensor_type[i]) for i in range(model.nsensor)}
    return tuple(name for name in file.outputs if kinds.get(name) == int(LENGTH))


def _positions(model: mujoco.MjModel) -> dict[str, str]:
    """Returns the sensor of the position of each joint that has one, by the joint's name."""
    return {
        model.joint(int(model.sensor_objid[i])).name: model.sensor(i).name
        for i in range(model.nsensor)
        if int(model.sensor_type[i]) == _POSITION and model.sensor(i).name
    }


def _moved_joints(model: mujoco.MjModel, sensors: Sequence[str]) -> tuple[str, ...]:
    """Returns the hinges and slides with names that move measured tendons."""
    ids = [int(model.sensor(name).objid[0]) for name in sensors]
    moving = np.asarray(_moved_by(model)[0][ids].any(axis=0))
    return tuple(
        model.joint(j).name
        for j in range(model.njnt)
        if int(model.jnt_type[j]) in _SCALAR and moving[model.jnt_dofadr[j]] and model.joint(j).name
    )


def _felt(model: mujoco.MjModel, ids: Sequence[int], fixed: set[int]) -> list[int]:
    """Returns the dofs that move tendons, and those that equalities tie to them, but the known."""
    tendons, rows = _moved_by(model)
    ties = [set(np.flatnonzero(row)) for row in rows]
    felt = set(np.flatnonzero(tendons[ids].any(axis=0)))
    while more := [tie for tie in ties if tie & felt and tie - felt]:
        felt |= more[0]
    return sorted(int(i) for i in felt - fixed)


def _moved_by(model: mujoco.MjModel) -> tuple[np.ndarray, np.ndarray]:
    """Returns which dofs move each tendon, (ntendon, nv), and each row of the equalities, (_, nv).

    The model is put into its own pose and into some poses about it.
    """
    model, rng, rows = copy.copy(model), np.random.default_rng(0), []
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    data = mujoco.MjData(model)
    for k in range(POSES):
        data.qpos[:] = model.qpos0
        if k:
            mujoco.mj_integratePos(model, data.qpos, SPREAD * rng.standard_normal(model.nv), 1.0)
        mujoco.mj_fwdPosition(model, data)
        equalities = data.efc_J.reshape(-1, model.nv)[: data.ne]
        rows.append((_tendon_rows(model, data), equalities.copy()))
    tendons, ties = (np.asarray(each) for each in zip(*rows, strict=True))
    return (np.abs(tendons) > 1e-9).any(axis=0), (np.abs(ties) > 1e-9).any(axis=0)


def _tendon_rows(model: mujoco.MjModel, data: mujoco.MjData) -> np.ndarray:
    """Returns d length / d q of all tendons, shape (ntendon, nv)."""
    out = np.zeros((model.ntendon, model.nv))
    mujoco.mju_sparse2dense(
        out, np.ravel(data.ten_J), model.ten_J_rownnz, model.ten_J_rowadr, model.ten_J_colind
    )
    return out
