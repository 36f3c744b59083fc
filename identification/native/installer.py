"""The joints' law, compiled and installed in this process.

MuJoCo holds one callback of a kind in a process. A package that has a passive force of its own
calls `add_joint_forces` in it and says so with `carry`: then either stands in for both.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import mujoco
from numba import types

from identification.errors import InputError
from identification.native import structs
from identification.native.cache import compile_once
from identification.native.joint_callback import FIELDS, add_joint_forces

_PROBE = """<mujoco>
  <size nuser_jnt="1"/>
  <worldbody><body><joint name="j"/><geom size="1"/></body></worldbody>
  <actuator><general joint="j" ctrlrange="-1 1" forcerange="-1 1"/></actuator>
</mujoco>"""

_CARRIERS: list[Any] = []  # callbacks that add the joints' forces; MuJoCo holds bare pointers


def carry(callback: Any) -> Any:
    """Say that a compiled passive callback calls `add_joint_forces`; returns it."""
    _CARRIERS.append(callback)
    return callback


def carries(callback: Any) -> bool:
    """Whether a passive callback adds the joints' forces."""
    return any(callback is own for own in _CARRIERS)


@cache
def _compiled() -> Any:
    """The callback, for this process."""
    model = mujoco.MjModel.from_xml_string(_PROBE)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)
    unseen = FIELDS - structs.check(model, data)
    if unseen:
        raise RuntimeError(
            f"MuJoCo {mujoco.__version__} does not show {', '.join(sorted(unseen))};"
            " install the mujoco version of the lock file"
        )

    def passive(m, d):  # type: ignore[no-untyped-def]
        add_joint_forces(m, d)

    signature = types.void(types.int64, types.int64)
    return carry(compile_once(passive, signature))


def install() -> None:
    """Install the law in this process; does nothing when it is installed already.

    Raises:
        InputError: another library has installed a passive callback of its own.
        RuntimeError: MuJoCo's structs are not laid out as declared.
    """
    present = mujoco.get_mjcb_passive()
    if carries(present):
        return
    if present is not None:
        raise InputError(
            "another library has installed mjcb_passive, and MuJoCo holds one a process;"
            " release it with mujoco.set_mjcb_passive(None), or use a process of its own"
        )
    mujoco.set_mjcb_passive(_compiled())
