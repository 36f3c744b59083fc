"""Joints that move what a log measures, and whose own pose no sensor of it measures.

A simulation begins with such a joint where the model's file has it, at rest, and so does each
window of a horizon. A base with a free joint then falls, and a search takes what the fall does for
a force that is missing. So does one on a slide that nothing holds. Hinges, and slides that rest,
may stay unmeasured. A free joint whose pose the robot's file measures is none any more
(`identification.robot.file.measured_base`).
"""

from __future__ import annotations

import copy
import re

import mujoco
import numpy as np

from identification.errors import InputError
from identification.logs.log import Log
from identification.model.predictor import output_dofs
from identification.refusals.trust import RobotFile
from identification.runtime.engine import quiet
from identification.storage.files import MODEL, read_bytes, toml_key

_SLIDE = int(mujoco.mjtJoint.mjJNT_SLIDE)
_WORDS = {int(mujoco.mjtJoint.mjJNT_FREE): "free", int(mujoco.mjtJoint.mjJNT_BALL): "ball",
          _SLIDE: "slide"}  # fmt: skip
# A slide falls if it goes this share of what a free body falls in so many seconds. A wheel comes to
# rest on the ground, a gripper at its fingers, and a brake or a balance holds a slide.
FALLS, SECONDS = 0.5, 0.5
STEPS = 20_000  # of this simulation at most; a model with finer steps takes longer ones
_WELD = int(mujoco.mjtEq.mjEQ_WELD)
_TIED = (_WELD, int(mujoco.mjtEq.mjEQ_CONNECT))  # equalities between bodies or sites
_SITE = int(mujoco.mjtObj.mjOBJ_SITE)


def refuse_unmeasured(file: RobotFile, model: mujoco.MjModel, log: Log) -> None:
    """Refuse a model with a joint that moves what a log measures, and that only falls or drifts."""
    if "joints" in file.trust:
        return
    felt = felt_trees(model, log)
    falling = _falling_slides(model, log)
    for j in np.flatnonzero(np.isin(model.jnt_type, [*_WORDS])):
        body = int(model.jnt_bodyid[j])
        if int(model.body_treeid[body]) not in felt or _is_welded(model, body):
            continue
        if model.jnt_type[j] == _SLIDE and j not in falling:
            continue
        raise _refusal(file, model, log, int(j))


def _falling_slides(model: mujoco.MjModel, log: Log) -> set[int]:
    """Returns the numbers of the slides that fall as the model begins."""
    measured = output_dofs(model, log.output_names)
    free = ~model.jnt_limited.astype(bool) & (np.ravel(model.jnt_stiffness) == 0)
    slides = [int(j) for j in np.flatnonzero((model.jnt_type == _SLIDE) & free)
              if int(model.jnt_dofadr[j]) not in measured]  # fmt: skip
    if not slides or not model.opt.gravity.any():
        return set()
    model, data = copy.copy(model), mujoco.MjData(model)
    model.opt.timestep = max(model.opt.timestep, SECONDS / STEPS)
    with quiet():
        mujoco.mj_forward(model, data)
        driven = {int(i) for i in data.moment_colind[: int(data.moment_rownnz.sum())]}
        begin = data.qpos.copy()
        mujoco.mj_step(model, data, nstep=int(np.ceil(SECONDS / model.opt.timestep)))
    far = FALLS * float(np.linalg.norm(model.opt.gravity)) * SECONDS**2 / 2
    gone = np.abs(data.qpos - begin)
    falling = {j for j in slides if gone[model.jnt_qposadr[j]] > far}
    return {j for j in falling if int(model.jnt_dofadr[j]) not in driven}


def _refusal(file: RobotFile, model: mujoco.MjModel, log: Log, j: int) -> InputError:
    """Returns the error for joint j."""
    kind, joint, body = (
        _WORDS[int(model.jnt_type[j])],
        model.joint(j).name,
        int(model.jnt_bodyid[j]),
    )
    name = model.body(body).name or f"number {body}"
    begin = "the simulation" if file.horizon is None else f"each window of {file.horizon:g} s"
    falls = kind == "slide" or (kind == "free" and bool(model.opt.gravity.any()))
    cure = f"weld {name} if it is fixed: delete the {kind} joint{_line(file, kind)}"
    if kind == "free":
        key = joint or (name if model.body(body).name else "NAME")
        cure += (
            f"; write {toml_key(key)} = [seven columns: x, y, z, and the quaternion w, x, y, z]"
            f" under [columns] in {file.path} if the log has its pose"
        )
    if kind == "slide":
        cure += "; add a jointpos sensor and its column if the log has it"
    if kind == "ball":
        cure += "; write hinges whose angles the log measures in its place if it turns"
    return InputError(
        f"{file.model} has a {kind} joint{f' {joint!r}' * bool(joint)} of body {name}, whose pose"
        f" no sensor of log {log.name!r} measures, so that {begin} begins with it where the model"
        f" has it, at rest, and it {'falls' if falls else 'moves freely'} from there; {cure}; or"
        f' write trust = ["joints"] into {file.path} if it truly begins so'
    )


def felt_trees(model: mujoco.MjModel, log: Log) -> set[int]:
    """Returns the kinematic trees that move what a log measures, by MuJoCo's numbers.

    These are the trees of the measured joints, and those that equalities or tendons tie to them.
    """
    felt = {int(model.dof_treeid[dof]) for dof in output_dofs(model, log.output_names)}
    ties = [{*map(int, trees)} - {-1} for trees in model.tendon_treeid]
    ties += [{int(model.body_treeid[b]) for b in _bodies(model, e)} - {-1}
             for e in np.flatnonzero(np.isin(model.eq_type, _TIED))]  # fmt: skip
    while more := [tie for tie in ties if tie & felt and tie - felt]:
        felt |= more[0]
    return felt


def _is_welded(model: mujoco.MjModel, body: int) -> bool:
    """Returns whether an equality welds a body to one that does not move."""
    return any(
        {int(model.body_weldid[b]) for b in _bodies(model, e)} == {int(model.body_weldid[body]), 0}
        for e in np.flatnonzero((model.eq_type == _WELD) & model.eq_active0.astype(bool))
    )


def _bodies(model: mujoco.MjModel, equality: np.integer) -> tuple[int, int]:
    """Returns the two bodies that an equality between bodies or sites ties to each other."""
    a, b = int(model.eq_obj1id[equality]), int(model.eq_obj2id[equality])
    if int(model.eq_objtype[equality]) == _SITE:
        return int(model.site_bodyid[a]), int(model.site_bodyid[b])
    return a, b


def _line(file: RobotFile, kind: str) -> str:
    """Returns the line where the model's file has a joint of a kind; "" unless it has just one."""
    wanted = rf"type\s*=\s*[\"']{kind}[\"']" + ("|<freejoint" if kind == "free" else "")
    text = read_bytes(file.model, what=MODEL).decode(errors="replace")
    lines = [n for n, line in enumerate(text.splitlines(), 1) for _ in re.findall(wanted, line)]
    return f" in line {lines[0]} of {file.model.name}" if len(lines) == 1 else ""
